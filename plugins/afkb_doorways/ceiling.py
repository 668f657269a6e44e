"""The ceiling: a level surface above one's head, facing down; it bounds the room upwards."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_mapping.from_above import on_grid
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

Array = NDArray[np.float64]

LOWEST_M = 2.0
"""Rooms are higher; what hangs lower is a shelf, a lamp, a lintel."""
OVER_EYE_M = 0.2
"""A surface that faces down is seen from below only: it lies this much above the camera."""
FARTHEST_M = 8.0
BIN_M, WITHIN_M, NOISE_SIGMAS = 0.04, 0.04, 2.0
"""Heights are counted in such bins; the points of one level lie within the second, or noise."""
TILT_DEG = 8.0
"""A level ceiling tilts no more, the error of a map's level included; sloping roofs do."""
CELL_M = 0.25
"""Squares by which its area is counted, those with a full neighbourhood only: a wall's points at
one height are a line."""
AREA_M2 = (0.4, 1.5)
"""Less than the first is the underside of something; the second is a ceiling."""
STEP_PX = 90.0
"""Focal length (px) over this: every so many pixels are read, as a ceiling is large."""


class CeilingDetector:
    """Finds the ceiling in a placed view, once, with `measures["is_ceiling"]` and its height.

    It is a bound: it keeps from leaving upwards (BlockAbility). Its height is that of the room.
    """

    name = "ceiling"
    affordances: tuple[str, ...] = ("BlockAbility",)
    stage = 0

    def detect(self, view: View, earlier: Sequence[Detection] = ()) -> list[Detection]:
        """The largest level surface overhead, if there is one."""
        if view.depth_m is None or view.camera is None:
            return []
        camera, T = view.camera, view.T_map_camera
        intrinsics = np.array([camera.fx, camera.fy, camera.cx, camera.cy])
        step = max(1, round(camera.fx / STEP_PX))
        lowest = max(LOWEST_M, float(T[2, 3]) + OVER_EYE_M)
        if not _may_see(view.depth_m.shape, intrinsics, T, lowest):
            return []
        points, depths, sigmas, u, v = _overhead(view.depth_m, intrinsics, T, step, lowest)
        level = _level(points, sigmas)
        if level is None:
            return []
        inside, height, tilt = level
        footprint = on_grid(points[inside], CELL_M)
        area = _inner(footprint) * CELL_M**2
        least, sure = AREA_M2
        p = min(1.0, (area - least) / (sure - least))
        if p <= 0:
            return []
        return [
            self._detection(
                points[inside], float(depths[inside].min()),
                extent(u[inside], v[inside]), footprint,
                0.97 * p, {"is_ceiling": 1.0, "height": height, "area": area, "tilt_deg": tilt},
                int(inside.sum()) * step**2,
            )
        ]  # fmt: skip

    def _detection(
        self,
        points: Array,
        range_m: float,
        image_box: tuple[int, int, int, int],
        footprint: Array,
        p: float,
        measures: dict[str, float],
        n_pixels: int,
    ) -> Detection:
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        x, y = (low + high) / 2
        height = measures["height"]
        sigma = depth_sigma(range_m)
        return Detection(
            detector=self.name,
            affordances={"BlockAbility": p},
            box=OrientedBox(
                (float(x), float(y), height),
                (float(high[0] - low[0]), float(high[1] - low[1]), WITHIN_M),
            ),
            position_xyz=np.array([x, y, height]),
            covariance_xyz=np.diag([1.0, 1.0, sigma**2]),
            footprint_xy=footprint,
            n_pixels=n_pixels,
            range_m=range_m,
            image_box=image_box,
            cut_by_image=True,
            measures=measures,
        )


def _may_see(shape: tuple[int, ...], intrinsics: Array, T: Array, lowest_m: float) -> bool:
    """Whether any corner of the image looks up steeply enough to reach a height in range."""
    fx, fy, cx, cy = intrinsics
    corners = [((u - cx) / fx, (v - cy) / fy, 1.0) for u in (0, shape[1]) for v in (0, shape[0])]
    steepest = max(float(T[2, :3] @ ray) for ray in corners)
    return steepest * FARTHEST_M + float(T[2, 3]) > lowest_m


def _inner(footprint: Array) -> int:
    """How many squares of a footprint (N, 2) have all four neighbours in it."""
    squares = {(x, y) for x, y in np.floor(footprint / CELL_M).astype(int).tolist()}
    beside = ((1, 0), (-1, 0), (0, 1), (0, -1))
    return sum(all((x + dx, y + dy) in squares for dx, dy in beside) for x, y in squares)


@kernel
def _overhead(
    depth_m: NDArray[np.float32], intrinsics: Array, T: Array, step: int, lowest_m: float
) -> tuple[Array, Array, Array, NDArray[np.int32], NDArray[np.int32]]:
    """Points (N, 3) above a height, map frame; their depths and noise, m, columns and rows."""
    fx, fy, cx, cy = intrinsics
    rows, cols = depth_m.shape
    most = (rows // step + 1) * (cols // step + 1)
    points, depths, sigmas = np.empty((most, 3)), np.empty(most), np.empty(most)
    us, vs = np.empty(most, np.int32), np.empty(most, np.int32)
    n = 0
    for v in range(0, rows, step):
        yc = (v - cy) / fy
        for u in range(0, cols, step):
            d = float(depth_m[v, u])
            if not 0.0 < d < FARTHEST_M:
                continue
            xc = (u - cx) / fx
            height = d * (T[2, 0] * xc + T[2, 1] * yc + T[2, 2]) + T[2, 3]
            if height < lowest_m:
                continue
            points[n, 0] = d * (T[0, 0] * xc + T[0, 1] * yc + T[0, 2]) + T[0, 3]
            points[n, 1] = d * (T[1, 0] * xc + T[1, 1] * yc + T[1, 2]) + T[1, 3]
            points[n, 2] = height
            depths[n], sigmas[n], us[n], vs[n] = d, depth_sigma(d), u, v
            n += 1
    return points[:n], depths[:n], sigmas[:n], us[:n], vs[:n]


def _level(points: Array, sigmas: Array) -> tuple[NDArray[np.bool_], float, float] | None:
    """Which points lie on the fullest level, its height (m) and tilt (degrees), or None."""
    if len(points) < 3:
        return None
    heights = points[:, 2]
    counts = np.bincount(((heights - LOWEST_M) / BIN_M).astype(int))
    # A level may straddle two bins.
    pairs = counts + np.append(counts[1:], 0)
    middle = LOWEST_M + (int(np.argmax(pairs)) + 1) * BIN_M
    inside = np.abs(heights - middle) < np.maximum(WITHIN_M, NOISE_SIGMAS * sigmas)
    height = float(np.median(heights[inside]))
    design = np.column_stack([points[inside, :2], np.ones(int(inside.sum()))])
    slopes = np.linalg.lstsq(design, heights[inside], rcond=None)[0][:2]
    tilt = math.degrees(math.atan(float(np.hypot(*slopes))))
    return (inside, height, tilt) if tilt <= TILT_DEG else None
