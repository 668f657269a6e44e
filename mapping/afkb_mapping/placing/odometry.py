"""How far odometry may be off between two views (Thrun et al., Probabilistic Robotics, §5.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import yaw_of

Array = NDArray[np.float64]

ODOMETRY_SHIFT = 0.10
"""Standard deviation of odometry's shift, m per m travelled."""
ODOMETRY_TURN = (0.10, 0.06)
"""Standard deviation of its turn, rad per rad turned and rad per m travelled."""
SCAN_FLOOR = (0.03, 0.03, 0.02)
"""What it may be off (m, m, rad) from where a scan was taken, however little the robot moved: a
laser sweeps while the robot drives on."""
IMAGE_FLOOR = (0.01, 0.01, 0.01)
"""... from where a depth image was taken: that is done at once; what is left is two clocks."""


def step_covariance(T_odom_before: Array, T_odom_after: Array) -> Array:
    """(3, 3) covariance of the step between two poses (4, 4): x, y (m), yaw (rad)."""
    T_step = np.linalg.inv(T_odom_before) @ T_odom_after
    length, turn = float(np.linalg.norm(T_step[:3, 3])), abs(yaw_of(T_step))
    shift = ODOMETRY_SHIFT * length
    yaw = ODOMETRY_TURN[0] * turn + ODOMETRY_TURN[1] * length
    return np.diag([shift**2, shift**2, yaw**2])
