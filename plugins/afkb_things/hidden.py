"""Things off every support: on one that is out of sight (paper Fig. 2, row 1), or on the floor."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body, Stand
from afkb_mapping.grid_components import HEIGHT, WIDTH, components
from afkb_mapping.image_regions import extent, order_by_label
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_things.above import FLOOR_M
from afkb_things.scene import Scene

NEAREST_FLOOR_M = 0.25
HIGHEST_M = 1.8
FARTHEST_M = 3.5
"""Beyond this, noise hides an opening and makes one of what it isn't."""
CELL_M = 0.015
WIDEST_M = 0.75
TALLEST_M = 0.5
BIN_M = (0.15, 0.85)
"""Lowest and highest rim of what stands on the floor: bins, baskets, boxes."""
HIDDEN_SHARE = 0.6
"""Share of a thing's lower outline that something nearer must cover."""


@dataclass(frozen=True, slots=True, eq=False)
class Loose:
    """Pixels off every support and wall, within range: columns, rows, and squares (N, 2)."""

    u: NDArray[np.int32]
    v: NDArray[np.int32]
    heights_m: NDArray[np.float32]
    ij: NDArray[np.int32]

    @classmethod
    def of(cls, scene: Scene) -> Loose:
        """All that things are looked for in, whether on hidden supports or on the floor."""
        low, high = min(NEAREST_FLOOR_M, FLOOR_M), max(HIGHEST_M, BIN_M[1])
        camera_xy = scene.camera_xyz[:2].copy()
        return cls(*_loose(scene.depth_m, scene.points, scene.labels, camera_xy, low, high))


@kernel
def _loose(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    labels: NDArray[np.int16],
    camera_xy: NDArray[np.float64],
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32], NDArray[np.int32]]:
    """Columns, rows, heights and squares of pixels between two heights, off supports and walls."""
    rows, cols = depth_m.shape
    us, vs = np.empty(rows * cols, np.int32), np.empty(rows * cols, np.int32)
    heights, ij = np.empty(rows * cols, np.float32), np.empty((rows * cols, 2), np.int32)
    n = 0
    for v in range(rows):
        for u in range(cols):
            if labels[v, u] != 0 or depth_m[v, u] <= 0:
                continue
            h = points[v, u, 2]
            dx, dy = points[v, u, 0] - camera_xy[0], points[v, u, 1] - camera_xy[1]
            if not (low_m < h < high_m) or dx * dx + dy * dy > FARTHEST_M * FARTHEST_M:
                continue
            us[n], vs[n], heights[n] = u, v, h
            ij[n, 0] = int((dx + FARTHEST_M) / CELL_M)
            ij[n, 1] = int((dy + FARTHEST_M) / CELL_M)
            n += 1
    return us[:n], vs[:n], heights[:n], ij[:n]


@kernel
def _grid_between(
    heights_m: NDArray[np.float32], ij: NDArray[np.int32], low_m: float, high_m: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.uint8]]:
    """Indexes of what lies between two heights, the square of each (flat), and their grid.

    On the grid a square is marked together with the next ones, so that small gaps close.
    """
    index, n = np.empty(len(heights_m), np.int64), 0
    i0 = j0 = np.int64(1 << 30)
    i1 = j1 = np.int64(-1)
    for k in range(len(heights_m)):
        if low_m < heights_m[k] < high_m:
            index[n] = k
            n += 1
            i, j = np.int64(ij[k, 0]), np.int64(ij[k, 1])
            i0, j0, i1, j1 = min(i0, i), min(j0, j), max(i1, i), max(j1, j)
    if n == 0:
        return index[:0], index[:0], np.zeros((1, 1), np.uint8)
    # an even corner: OpenCV numbers components by blocks of two squares
    i0, j0 = i0 // 2 * 2, j0 // 2 * 2
    grid = np.zeros((i1 - i0 + 2, j1 - j0 + 2), np.uint8)
    square = np.empty(n, np.int64)
    for m in range(n):
        i, j = ij[index[m], 0] - i0, ij[index[m], 1] - j0
        grid[i, j] = grid[i, j + 1] = grid[i + 1, j] = grid[i + 1, j + 1] = 1
        square[m] = i * grid.shape[1] + j
    return index[:n], square, grid


@kernel
def _hidden_below(
    u: NDArray[np.int32], v: NDArray[np.int32], depth_m: NDArray[np.float32], u0: int, u1: int
) -> float:
    """Share of a thing's image columns below which something clearly nearer stands."""
    rows = depth_m.shape[0]
    lowest = np.full(u1 - u0, -1)
    for k in range(len(u)):
        lowest[u[k] - u0] = max(lowest[u[k] - u0], v[k])
    hidden = total = 0
    for c in range(u1 - u0):
        if lowest[c] < 0:
            continue
        total += 1
        z = depth_m[lowest[c], u0 + c]
        for i in range(lowest[c] + 1, min(lowest[c] + 7, rows)):
            below = depth_m[i, u0 + c]
            if below > 0:
                hidden += below < z - 0.03 - 3.0 * depth_sigma(z)
                break
    return hidden / max(total, 1)


def things_on_hidden_supports(scene: Scene, loose: Loose, min_pixels: int) -> Iterator[Body]:
    """Compact bodies that stand apart, seen from above, and whose foot something nearer covers."""
    for u, v, heights in _apart_from_above(loose, NEAREST_FLOOR_M, HIGHEST_M, min_pixels):
        u0, _, u1, _ = extent(u, v)
        if np.ptp(heights) > TALLEST_M or _hidden_below(u, v, scene.depth_m, u0, u1) < HIDDEN_SHARE:
            continue
        yield Body(u, v, *scene.at(u, v), scene.depth_m.shape, Stand.HIDDEN, None)


def things_on_the_floor(scene: Scene, loose: Loose, min_pixels: int) -> Iterator[Body]:
    """Compact bodies that stand apart on the floor, as bins and baskets do."""
    for u, v, heights in _apart_from_above(loose, FLOOR_M, BIN_M[1] + 0.1, min_pixels):
        if BIN_M[0] < percentile(heights, 98.0) < BIN_M[1]:
            yield Body(u, v, *scene.at(u, v), scene.depth_m.shape, Stand.ON_FLOOR, 0.0)


def _apart_from_above(
    loose: Loose, low_m: float, high_m: float, min_pixels: int
) -> Iterator[tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32]]]:
    """Pixels (u, v) and heights of what is narrow enough and alone, seen from above."""
    index, square, grid = _grid_between(loose.heights_m, loose.ij, low_m, high_m)
    if len(index) < min_pixels:
        return
    parts, measures = components(grid, True)
    wide = np.maximum(measures[:, WIDTH], measures[:, HEIGHT]) * CELL_M
    narrow = wide <= WIDEST_M
    narrow[0] = False
    u, v, heights, starts = _by_part(
        loose.u, loose.v, loose.heights_m, index, square, parts.ravel(), narrow
    )
    for k in np.flatnonzero(np.diff(starts) >= min_pixels):
        part = slice(int(starts[k]), int(starts[k + 1]))
        yield u[part], v[part], heights[part]


@kernel
def _by_part(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    heights_m: NDArray[np.float32],
    index: NDArray[np.int64],
    square: NDArray[np.int64],
    parts: NDArray[np.int32],
    wanted: NDArray[np.bool_],
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32], NDArray[np.int64]]:
    """Pixels and heights of the wanted parts, part by part, and where each begins.

    `parts` (X * Y,) is a grid, and `square` (N,) says where each of the pixels `index` lies on it.
    """
    order, starts = order_by_label(parts[square], wanted)
    us, vs = np.empty(len(order), np.int32), np.empty(len(order), np.int32)
    heights = np.empty(len(order), np.float32)
    for n in range(len(order)):
        k = index[order[n]]
        us[n], vs[n], heights[n] = u[k], v[k], heights_m[k]
    return us, vs, heights, starts
