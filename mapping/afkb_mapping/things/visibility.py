"""Whether a view could have seen something: told apart are seen, empty, occluded, not looked at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.kernels import kernel

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
        self._depth_m = view.depth_m
        self._eye_xy = view.T_map_base[:2, 3] if view.T_map_base is not None else np.zeros(2)
        if view.depth_m is not None:
            self._eye_xy = view.T_map_camera[:2, 3]
            self._intrinsics = intrinsics_of(view)
            self._T_camera_map = np.asarray(np.linalg.inv(view.T_map_camera), np.float64)

    @cached_property
    def reach(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Corners (2,) of a box, map frame, m, outside of which the view looks at nothing."""
        if self._depth_m is None:
            return self._eye_xy, self._eye_xy
        fx, fy, cx, cy = self._intrinsics
        rows, cols = self._depth_m.shape
        aside = max(cx + 1, cols - cx) / fx, max(cy + 1, rows - cy) / fy
        farthest = USABLE_RANGE_M * float(np.linalg.norm([1.0, *aside]))
        return self._eye_xy - farthest, self._eye_xy + farthest

    def look(self, points_xy: NDArray[np.float64], height_m: float, most: int = 200) -> Look:
        """How the view looked at points (N, 2), map frame, that lie `height_m` above the floor.

        A point is *empty* where the depth behind it was measured, *hit* where depth agrees with
        it, otherwise occluded or without return. Of many points about `most` are looked at.
        """
        if self._depth_m is None or not len(points_xy):
            return NOT_LOOKED_AT
        some_xy = np.ascontiguousarray(points_xy[:: max(1, len(points_xy) // most)])
        return Look(*_look(some_xy, height_m, self._depth_m, self._intrinsics, self._T_camera_map))

    def sees_through(self, points_xy: NDArray[np.float64], height_m: float) -> NDArray[np.bool_]:
        """(N,) whether depth lies clearly behind points (N, 2), map frame, at a height, m."""
        behind, z = self._behind(points_xy, height_m)
        through: NDArray[np.bool_] = behind > MARGIN_M + MARGIN_PER_RANGE * z
        return through

    def meets(
        self, points_xy: NDArray[np.float64], height_m: float, within_m: float
    ) -> NDArray[np.bool_]:
        """(N,) whether depth agrees with points (N, 2) at a height, no further off than that, m."""
        behind, z = self._behind(points_xy, height_m)
        met: NDArray[np.bool_] = np.abs(behind) <= MARGIN_M + MARGIN_PER_RANGE * z
        return met & (z <= within_m)

    def _behind(
        self, points_xy: NDArray[np.float64], height_m: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N,) how far behind each point depth was measured, NaN where it wasn't; its depth, m."""
        if self._depth_m is None:
            return np.full(len(points_xy), np.nan), np.full(len(points_xy), np.inf)
        fx, fy, cx, cy = self._intrinsics
        heights = np.full(len(points_xy), height_m)
        T = self._T_camera_map
        x, y, z = T[:3, :3] @ np.vstack([points_xy.T, heights]) + T[:3, 3:]
        ahead = (z > NEAREST_M) & (z < USABLE_RANGE_M)
        depths = np.where(ahead, z, 1.0)
        u = np.round(fx * x / depths + cx).astype(np.int64)
        v = np.round(fy * y / depths + cy).astype(np.int64)
        rows, cols = self._depth_m.shape
        inside = ahead & (u >= 0) & (u < cols) & (v >= 0) & (v < rows)
        measured = self._depth_m[v.clip(0, rows - 1), u.clip(0, cols - 1)].astype(np.float64)
        return np.where(inside & (measured > 0), measured - z, np.nan), z


@kernel
def _look(
    points_xy: NDArray[np.float64],
    height_m: float,
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
) -> tuple[float, float, float]:
    """Shares of points (N, 2), N > 0: in view; of those, seen through, and hit."""
    fx, fy, cx, cy = intrinsics
    inside, empty, hit = 0, 0, 0
    for n in range(len(points_xy)):
        px, py = points_xy[n, 0], points_xy[n, 1]
        z = T[2, 0] * px + T[2, 1] * py + T[2, 2] * height_m + T[2, 3]
        if not NEAREST_M < z < USABLE_RANGE_M:
            continue
        x = T[0, 0] * px + T[0, 1] * py + T[0, 2] * height_m + T[0, 3]
        y = T[1, 0] * px + T[1, 1] * py + T[1, 2] * height_m + T[1, 3]
        u, v = round(fx * x / z + cx), round(fy * y / z + cy)
        if not (0 <= u < depth_m.shape[1] and 0 <= v < depth_m.shape[0]):
            continue
        inside += 1
        measured = depth_m[v, u]
        if measured <= 0:
            continue
        behind, margin = measured - z, MARGIN_M + MARGIN_PER_RANGE * z
        empty += behind > margin
        hit += abs(behind) <= margin
    if inside == 0:
        return 0.0, 0.0, 0.0
    return inside / len(points_xy), empty / inside, hit / inside
