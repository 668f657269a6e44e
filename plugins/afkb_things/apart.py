"""What stands apart from all else, seen from above, of what is off every support and wall."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.depth_points import points_of_row
from afkb_mapping.grid.components import HEIGHT, WIDTH, components
from afkb_mapping.image_regions import extent, order_by_label
from afkb_mapping.kernels import kernel
from afkb_things.cells import cell_size
from afkb_things.scene import Scene

FARTHEST_M = 3.5
"""Beyond this, noise hides an opening and makes one of what it isn't."""
CELL_M = 0.015
WIDEST_M = 0.75
EACH = np.int64(1)
"""Every pixel is taken; of a type, as a literal is not, so that `_loose` is compiled once."""


@dataclass(frozen=True, slots=True, eq=False)
class Loose:
    """Samples of what is off every support and wall, within range: one pixel of each cell.

    Columns, rows, heights (N,), m, and grid squares (N, 2), seen from above; cells are `thin`
    pixels wide.
    """

    thin: int

    u: NDArray[np.int32]
    v: NDArray[np.int32]
    heights_m: NDArray[np.float32]
    ij: NDArray[np.int32]

    @classmethod
    def of(cls, scene: Scene, low_m: float, high_m: float) -> Loose:
        """The samples of a view between two heights, m."""
        thin = cell_size(float(scene.intrinsics[0]))
        box = (0, 0, scene.depth_m.shape[1], scene.depth_m.shape[0])
        return cls(thin, *_loose(*_seen(scene), box, thin, low_m, high_m))


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


@dataclass(frozen=True, slots=True, eq=False)
class Apart:
    """Samples of what stands apart, seen from above: columns, rows, heights (N,), m.

    It is the part so numbered of a grid, whose corner is a square; its heights lie between two, m.
    """

    u: NDArray[np.int32]
    v: NDArray[np.int32]
    heights_m: NDArray[np.float32]
    thin: int
    part: int
    parts: NDArray[np.int32]
    corner: tuple[int, int]
    between_m: tuple[float, float]

    def pixels(self, scene: Scene) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Columns and rows of all its pixels."""
        u0, v0, u1, v1 = extent(self.u, self.v)
        grow = self.thin - 1
        box = (u0 - grow, v0 - grow, u1 + grow, v1 + grow)
        return _of_part(*_seen(scene), box, self.parts, *self.corner, self.part, *self.between_m)


def apart_from_above(loose: Loose, low_m: float, high_m: float, min_pixels: int) -> Iterator[Apart]:
    """What between two heights is narrow enough and alone, seen from above."""
    grid, i0, j0 = _grid_between(loose.heights_m, loose.ij, low_m, high_m)
    parts, measures = components(grid, True)
    narrow = np.maximum(measures[:, WIDTH], measures[:, HEIGHT]) * CELL_M <= WIDEST_M
    narrow[0] = False
    of = _part_of_each(loose.heights_m, loose.ij, parts, i0, j0, low_m, high_m)
    order, starts = order_by_label(of, narrow)
    for k in np.flatnonzero(np.diff(starts) * loose.thin**2 >= min_pixels):
        own = order[starts[k] : starts[k + 1]]
        samples = (loose.u[own], loose.v[own], loose.heights_m[own])
        yield Apart(*samples, loose.thin, int(k), parts, (i0, j0), (low_m, high_m))


@kernel
def _part_of_each(
    heights_m: NDArray[np.float32],
    ij: NDArray[np.int32],
    parts: NDArray[np.int32],
    i0: int,
    j0: int,
    low_m: float,
    high_m: float,
) -> NDArray[np.int32]:
    """Part of a grid that each sample (N,) between two heights belongs to; 0 for others."""
    out = np.zeros(len(heights_m), np.int32)
    for n in range(len(heights_m)):
        if low_m < heights_m[n] < high_m:
            out[n] = parts[ij[n, 0] - i0, ij[n, 1] - j0]
    return out


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
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Columns and rows of all pixels of a part of a grid, within an image box.

    A part is known by one pixel of each cell: what lies in the next square is of it, too.
    """
    rows, cols = depth_m.shape
    within = (max(box[0], 0), max(box[1], 0), min(box[2], cols), min(box[3], rows))
    u, v, _, ij = _loose(depth_m, labels, intrinsics, T_map_camera, within, EACH, low_m, high_m)
    n = 0
    for k in range(len(u)):
        i, j = ij[k, 0] - i0, ij[k, 1] - j0
        if _near(parts, part, i, j):
            u[n], v[n] = u[k], v[k]
            n += 1
    return u[:n], v[:n]


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
