"""Odometry that drifts: what wheels say of a true way."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import T_from_xy_yaw, wrap_angle, yaw_of
from afkb_simulation.world_file import OdometryDrift


def drifting(
    T_world_base: Sequence[NDArray[np.float64]], drift: OdometryDrift, rng: np.random.Generator
) -> list[NDArray[np.float64]]:
    """`T_odom_base` (4x4) for each true pose; the first is the identity.

    Each run has a bias per metre and per radian; each step adds noise of the same size.
    """
    bias = rng.standard_normal(3)
    poses = [np.eye(4)]
    for before, after in pairwise(T_world_base):
        step = np.linalg.inv(before) @ after
        error = bias + rng.standard_normal(3)
        metres, turned = float(np.hypot(step[0, 3], step[1, 3])), wrap_angle(yaw_of(step))
        along = 1 + drift.along_per_m * error[0]
        yaw = turned * (1 + drift.yaw_per_rad * error[1]) + drift.yaw_per_m * metres * error[2]
        measured = T_from_xy_yaw(step[0, 3] * along, step[1, 3] * along, yaw)
        poses.append(poses[-1] @ measured)
    return poses
