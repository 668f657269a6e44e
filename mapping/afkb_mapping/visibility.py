"""Whether a view could have seen something: told apart are seen, empty, occluded, not looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View

MARGIN_M = 0.10
MARGIN_PER_RANGE = 0.03
"""A surface counts as missing only where depth lies clearly behind it: 10 cm and 3 % of range,
three times a Kinect's noise at 4 m plus what the pose may be off."""
USABLE_RANGE_M = 4.0


@dataclass(frozen=True, slots=True)
class Look:
    """Shares of a set of points: inside the image and range; of those, seen through, and hit."""

    in_view: float
    empty: float
    hit: float


NOT_LOOKED_AT = Look(0.0, 0.0, 0.0)


def look(view: View, points_xyz: NDArray[np.float64]) -> Look:
    """How a view looked at points (N, 3) of the map frame.

    A point is *empty* where the depth behind it was measured, *hit* where depth agrees with it,
    otherwise occluded or without return.
    """
    if view.depth_m is None or view.camera is None or not len(points_xyz):
        return NOT_LOOKED_AT
    T = np.linalg.inv(view.T_map_camera)
    x, y, z = (points_xyz @ T[:3, :3].T + T[:3, 3]).T
    ahead = (z > 0.3) & (z < USABLE_RANGE_M)
    safe = np.where(ahead, z, 1.0)
    u = np.round(view.camera.fx * x / safe + view.camera.cx).astype(int)
    v = np.round(view.camera.fy * y / safe + view.camera.cy).astype(int)
    inside = ahead & (u >= 0) & (u < view.camera.width) & (v >= 0) & (v < view.camera.height)
    if not inside.any():
        return NOT_LOOKED_AT
    measured = view.depth_m[v[inside], u[inside]]
    behind = measured - z[inside]
    margin = MARGIN_M + MARGIN_PER_RANGE * z[inside]
    returned = measured > 0
    return Look(
        float(inside.mean()),
        float((returned & (behind > margin)).mean()),
        float((returned & (np.abs(behind) <= margin)).mean()),
    )
