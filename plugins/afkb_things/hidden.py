"""Things off every support: on one that is out of sight (paper Fig. 2, row 1), or on the floor."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body, Stand
from afkb_mapping.depth_points import points_of_row
from afkb_mapping.grid_components import HEIGHT, WIDTH, components
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_things.above import FLOOR_M
from afkb_things.cells import cell_size
from afkb_things.scene import Scene

FARTHEST_M = 3.5
"""Beyond this, noise hides an opening and makes one of what it isn't."""
CELL_M = 0.015
WIDEST_M = 0.75
TALLEST_M = 0.5
BIN_M = (0.15, 0.85)
"""Lowest and highest rim of what stands on the floor: bins, baskets, boxes."""
LOW_M, HIGH_M = (0.25, FLOOR_M), (1.8, BIN_M[1] + 0.1)
"""Between these heights is looked for what stands on hidden supports, and for what on the floor."""
COUNT = 4
HIDDEN_SHARE = 0.6
"""Share of a thing's lower outline that something nearer must cover."""


@dataclass(frozen=True, slots=True, eq=False)
class Loose:
    """Samples of what is off every support and wall, within range: one pixel of each cell.

    Columns, rows, heights (N,), m, and grid squares (N, 2), seen from above.
    """

    u: NDArray[np.int32]
    v: NDArray[np.int32]
    heights_m: NDArray[np.float32]
    ij: NDArray[np.int32]

    @classmethod
    def of(cls, scene: Scene) -> Loose:
        """All that things are looked for in, whether on hidden supports or on the floor."""
        thin = cell_size(float(scene.intrinsics[0]))
        box = (0, 0, scene.depth_m.shape[1], scene.depth_m.shape[0])
        return cls(*_loose(*_seen(scene), box, thin, min(LOW_M), max(HIGH_M)))


def _seen(scene: Scene) -> tuple[NDArray[Any], ...]:
    return scene.depth_m, scene.labels, scene.intrinsics, scene.T_map_camera


@kernel
def _loose(
    depth_m: NDArray[np.float32],
    labels: NDArray[np.int16],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    box: tuple[int, int, int, int],
    thin: int,
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32], NDArray[np.int32]]:
    """Columns, rows, heights and squares of pixels between two heights, off supports and walls.

    Of each `thin` rows and columns in an image box, one.
    """
    u0, v0, u1, v1 = box
    most = ((u1 - u0) // thin + 1) * ((v1 - v0) // thin + 1)
    us, vs = np.empty(most, np.int32), np.empty(most, np.int32)
    heights, ij = np.empty(most, np.float32), np.empty((most, 2), np.int32)
    row, reach = np.empty((3, depth_m.shape[1]), np.float32), np.float32(FARTHEST_M)
    x0, y0 = np.float32(T_map_camera[0, 3]), np.float32(T_map_camera[1, 3])
    low, high, per_m = np.float32(low_m), np.float32(high_m), np.float32(1.0 / CELL_M)
    n = 0
    for v in range(v0, v1, thin):
        points_of_row(depth_m, v, intrinsics, T_map_camera, row, u0, u1)
        for u in range(u0, u1, thin):
            if labels[v, u] != 0 or depth_m[v, u] <= 0:
                continue
            h, dx, dy = row[2, u], row[0, u] - x0, row[1, u] - y0
            if not (low < h < high) or dx * dx + dy * dy > reach * reach:
                continue
            us[n], vs[n], heights[n] = u, v, h
            ij[n, 0], ij[n, 1] = int((dx + reach) * per_m), int((dy + reach) * per_m)
            n += 1
    return us[:n], vs[:n], heights[:n], ij[:n]


@kernel
def _grid_between(
    heights_m: NDArray[np.float32], ij: NDArray[np.int32], low_m: float, high_m: float
) -> tuple[NDArray[np.uint8], int, int]:
    """Grid of the squares that hold samples between two heights, and the square at its corner.

    A square is marked together with the next ones, so that small gaps close.
    """
    i0 = j0 = 1 << 30
    i1 = j1 = -1
    for k in range(len(heights_m)):
        if low_m < heights_m[k] < high_m:
            i, j = int(ij[k, 0]), int(ij[k, 1])
            i0, j0, i1, j1 = min(i0, i), min(j0, j), max(i1, i), max(j1, j)
    if i1 < 0:
        return np.zeros((1, 1), np.uint8), 0, 0
    grid = np.zeros((i1 - i0 + 2, j1 - j0 + 2), np.uint8)
    for k in range(len(heights_m)):
        if low_m < heights_m[k] < high_m:
            i, j = ij[k, 0] - i0, ij[k, 1] - j0
            grid[i, j] = grid[i, j + 1] = grid[i + 1, j] = grid[i + 1, j + 1] = 1
    return grid, i0, j0


@kernel
def _hidden_below(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    u0: int,
    u1: int,
    noise: float,
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
                hidden += below < z - 0.03 - 3.0 * noise * depth_sigma(z)
                break
    return hidden / max(total, 1)


def things_on_hidden_supports(scene: Scene, loose: Loose, min_pixels: int) -> Iterator[Body]:
    """Compact bodies that stand apart, seen from above, and whose foot something nearer covers."""
    apart = _apart_from_above(scene, loose, LOW_M[0], HIGH_M[0], TALLEST_M, 0.0, min_pixels)
    for u, v, heights in apart:
        u0, _, u1, _ = extent(u, v)
        if (
            np.ptp(heights) > TALLEST_M
            or _hidden_below(u, v, scene.depth_m, u0, u1, scene.noise) < HIDDEN_SHARE
        ):
            continue
        yield Body(
            u, v, *scene.at(u, v), scene.depth_m.shape, Stand.HIDDEN, None, noise=scene.noise
        )


def things_on_the_floor(scene: Scene, loose: Loose, min_pixels: int) -> Iterator[Body]:
    """Compact bodies that stand apart on the floor, as bins and baskets do."""
    tallest = HIGH_M[1] - LOW_M[1]
    apart = _apart_from_above(scene, loose, LOW_M[1], HIGH_M[1], tallest, BIN_M[0], min_pixels)
    for u, v, heights in apart:
        if BIN_M[0] < percentile(heights, 98.0) < BIN_M[1]:
            yield Body(
                u, v, *scene.at(u, v), scene.depth_m.shape, Stand.ON_FLOOR, 0.0, noise=scene.noise
            )


def _apart_from_above(
    scene: Scene,
    loose: Loose,
    low_m: float,
    high_m: float,
    tallest_m: float,
    least_top_m: float,
    min_pixels: int,
) -> Iterator[tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32]]]:
    """Pixels (u, v) and heights of what is narrow enough and alone, seen from above.

    Looked at is what lies between two heights; left out what is taller, or has a lower top.
    """
    thin = cell_size(float(scene.intrinsics[0]))
    grid, *corner = _grid_between(loose.heights_m, loose.ij, low_m, high_m)
    parts, measures = components(grid, True)
    wide = np.maximum(measures[:, WIDTH], measures[:, HEIGHT]) * CELL_M
    wide[0] = math.inf
    samples = (loose.u, loose.v, loose.heights_m, loose.ij)
    boxes, ends = _boxes(*samples, parts, *corner, len(measures), low_m, high_m)
    enough = (wide <= WIDEST_M) & (boxes[:, COUNT] * thin * thin >= min_pixels)
    enough &= (ends[:, 1] - ends[:, 0] <= tallest_m) & (ends[:, 1] > least_top_m)
    for k in np.flatnonzero(enough):
        u0, v0, u1, v1 = (int(n) for n in boxes[k, :4])
        box = (u0 - thin + 1, v0 - thin + 1, u1 + thin, v1 + thin)
        u, v, heights = _of_part(*_seen(scene), box, parts, *corner, k, low_m, high_m)
        if len(u) >= min_pixels:
            yield u, v, heights


@kernel
def _boxes(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    heights_m: NDArray[np.float32],
    ij: NDArray[np.int32],
    parts: NDArray[np.int32],
    i0: int,
    j0: int,
    count: int,
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Of each part's samples: first and last columns and rows, and number; lowest and highest."""
    out, ends = np.zeros((count, 5), np.int64), np.zeros((count, 2))
    out[:, 0], out[:, 1], ends[:, 0] = 1 << 30, 1 << 30, math.inf
    for n in range(len(u)):
        h = heights_m[n]
        if low_m < h < high_m:
            own = parts[ij[n, 0] - i0, ij[n, 1] - j0]
            out[own, 0], out[own, 1] = min(out[own, 0], u[n]), min(out[own, 1], v[n])
            out[own, 2], out[own, 3] = max(out[own, 2], u[n]), max(out[own, 3], v[n])
            out[own, COUNT] += 1
            ends[own, 0], ends[own, 1] = min(ends[own, 0], h), max(ends[own, 1], h)
    return out, ends


@kernel
def _of_part(
    depth_m: NDArray[np.float32],
    labels: NDArray[np.int16],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    box: tuple[int, int, int, int],
    parts: NDArray[np.int32],
    i0: int,
    j0: int,
    part: int,
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32]]:
    """Columns, rows and heights of all pixels of a part of a grid, within an image box.

    A part is known by one pixel of each cell: what lies in the next square is of it, too.
    """
    rows, cols = depth_m.shape
    within = (max(box[0], 0), max(box[1], 0), min(box[2], cols), min(box[3], rows))
    u, v, heights, ij = _loose(depth_m, labels, intrinsics, T_map_camera, within, 1, low_m, high_m)
    n = 0
    for k in range(len(u)):
        i, j = ij[k, 0] - i0, ij[k, 1] - j0
        if _near(parts, part, i, j):
            u[n], v[n], heights[n] = u[k], v[k], heights[k]
            n += 1
    return u[:n], v[:n], heights[:n]


@kernel
def _near(parts: NDArray[np.int32], part: int, i: int, j: int) -> bool:
    """Whether a square or one next to it is of a part."""
    rows, cols = parts.shape
    if 0 <= i < rows and 0 <= j < cols and parts[i, j] > 0:
        return bool(parts[i, j] == part)
    for a in range(max(i - 1, 0), min(i + 2, rows)):
        for b in range(max(j - 1, 0), min(j + 2, cols)):
            if parts[a, b] == part:
                return True
    return False
