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
NEAREST_M, USABLE_RANGE_M = 0.3, 4.0


@dataclass(frozen=True, slots=True)
class Look:
    """Shares of a set of points: inside the image and range; of those, seen through, and hit."""

    in_view: float
    empty: float
    hit: float


NOT_LOOKED_AT = Look(0.0, 0.0, 0.0)


class Sight:
    """What one placed view can tell about points of the map frame; without depth, nothing."""

    def __init__(self, view: View) -> None:
        self._depth_m, self._camera = view.depth_m, view.camera
        if view.depth_m is not None:
            self._T_camera_map = np.linalg.inv(view.T_map_camera)

    def look(self, points_xyz: NDArray[np.float64]) -> Look:
        """How the view looked at points (N, 3).

        A point is *empty* where the depth behind it was measured, *hit* where depth agrees with
        it, otherwise occluded or without return.
        """
        if self._depth_m is None or self._camera is None or not len(points_xyz):
            return NOT_LOOKED_AT
        camera, T = self._camera, self._T_camera_map
        x, y, z = (points_xyz @ T[:3, :3].T + T[:3, 3]).T
        ahead = (z > NEAREST_M) & (z < USABLE_RANGE_M)
        if not ahead.any():
            return NOT_LOOKED_AT
        safe = np.where(ahead, z, 1.0)
        u = np.round(camera.fx * x / safe + camera.cx).astype(int)
        v = np.round(camera.fy * y / safe + camera.cy).astype(int)
        inside = ahead & (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height)
        if not inside.any():
            return NOT_LOOKED_AT
        measured = self._depth_m[v[inside], u[inside]]
        behind = measured - z[inside]
        margin = MARGIN_M + MARGIN_PER_RANGE * z[inside]
        returned = measured > 0
        return Look(
            float(inside.mean()),
            float((returned & (behind > margin)).mean()),
            float((returned & (np.abs(behind) <= margin)).mean()),
        )

    def may_see(self, xyz: NDArray[np.float64], radius_m: float) -> bool:
        """Whether anything within `radius_m` of a point can be in range at all: a quick test."""
        if self._depth_m is None:
            return False
        z = float(self._T_camera_map[2, :3] @ xyz + self._T_camera_map[2, 3])
        return NEAREST_M - radius_m < z < USABLE_RANGE_M + radius_m
