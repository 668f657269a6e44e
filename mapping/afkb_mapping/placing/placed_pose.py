"""Where a view was taken, and how a planar motion about a point corrects that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.placing.scan_matching import rotation

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPose:
    """Where a view was taken.

    - `T_map_base`: 4x4, base in the map frame. `covariance`: (3, 3) of x, y (m), yaw (rad).
    - `matched`: what it sees fixed it; else it is odometry's. `overlap`: fraction of the view's
      surface that lies on the map's.
    """

    T_map_base: Array
    covariance: Array
    matched: bool
    overlap: float


def about(pivot: Array, motion: Array) -> Array:
    """4x4 planar transform that turns about the pivot by motion[2] and shifts by motion[:2]."""
    T = T_from_xy_yaw(0.0, 0.0, float(motion[2]))
    T[:2, 3] = pivot + motion[:2] - rotation(float(motion[2])) @ pivot
    return T
