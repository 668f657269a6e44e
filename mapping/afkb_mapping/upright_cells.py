"""Where something tall stands, and where something low: what a doorway's jambs are held against.

A laser at shin height can't tell a wall's end from a cabinet's; depth can, but sees little at once.
What views have seen is kept by cell, so that memory grows with the area and not with time.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb_mapping.panorama import Panorama

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CELL_M = 0.05
"""About a beam spacing at five metres, and half of what a wall is thick."""
TRUSTED_M = 5.0
"""Further away depth is wrong by more than a cell."""
OVER_M = 0.4
"""One looks over what is low, where the nearest tall thing is this much further."""
LEAST_VIEWS = 2
"""What a single view shows may be a passer-by, or pixels at an edge."""
TALL_SHARE = 0.25
"""A cell of which less is tall is a low thing that hid its wall once or twice."""

Cell = tuple[int, int]


class UprightCells:
    """Counts, by cell of the plan, the views that saw something tall there, and something low."""

    def __init__(self) -> None:
        self._tall: defaultdict[Cell, int] = defaultdict(int)
        self._low: defaultdict[Cell, int] = defaultdict(int)
        self._knee: defaultdict[Cell, int] = defaultdict(int)

    def add(self, panorama: Panorama) -> None:
        """Take in what one view shows."""
        for cell in _cells(panorama, panorama.tall_m, panorama.tall_m < TRUSTED_M):
            self._tall[cell] += 1
        over = panorama.low_m < TRUSTED_M
        over &= ~(panorama.tall_m < panorama.low_m + OVER_M)
        for cell in _cells(panorama, panorama.low_m, over):
            self._low[cell] += 1
        over &= ~(panorama.waist_m < panorama.low_m + OVER_M)
        for cell in _cells(panorama, panorama.low_m, over):
            self._knee[cell] += 1

    def tall(self, points_xy: Array, reach_m: float) -> float:
        """Share of what stands within reach of points (N, 2), m, that is tall; NaN without any."""
        cells = _around(points_xy, reach_m)
        tall = sum(self._tall.get(c, 0) for c in cells)
        low = sum(self._low.get(c, 0) for c in cells)
        return tall / (tall + low) if tall + low >= LEAST_VIEWS else float("nan")

    def knee_high(self, points_xy: Array, reach_m: float) -> float:
        """Share of the low things within reach of points (N, 2), m, that end below the waist."""
        cells = _around(points_xy, reach_m)
        low = sum(self._low.get(c, 0) for c in cells)
        return sum(self._knee.get(c, 0) for c in cells) / low if low else 0.0

    def stands_on(self, points_xy: Array) -> float:
        """Share of points (N, 2), m, at which something was seen to stand, of any height."""
        hit = [
            any(self._count(c) >= LEAST_VIEWS for c in _around(point[None], CELL_M))
            for point in points_xy
        ]
        return float(np.mean(hit))

    def views(self, point_xy: Array) -> int:
        """How many views saw something stand at a point (2,), m, or in a cell beside it."""
        return max(self._count(c) for c in _around(point_xy[None], 1.5 * CELL_M))

    def mark(self, grid: OccupancyGrid) -> Mask:
        """(rows, cols) of a grid: cells in which something stands that a laser may look under."""
        cells = [c for c in {**self._tall, **self._low} if self._count(c) >= LEAST_VIEWS]
        return _marked(cells, grid)

    def mark_tall(self, grid: OccupancyGrid) -> Mask:
        """(rows, cols) of a grid: cells in which something tall stands, as far as was seen."""
        cells = [c for c, n in self._tall.items() if n >= TALL_SHARE * self._count(c)]
        return _marked(cells, grid)

    def _count(self, cell: Cell) -> int:
        return self._tall.get(cell, 0) + self._low.get(cell, 0)


def _marked(cells: Sequence[Cell], grid: OccupancyGrid) -> Mask:
    """(rows, cols) of a grid: where the middles of these cells lie."""
    marked: Mask = np.zeros(grid.probability.shape, dtype=np.bool_)
    if cells:
        middles = (np.array(cells) + 0.5) * CELL_M - np.array(grid.origin_xy)
        cols, rows = np.floor(middles / grid.resolution_m).astype(int).T
        inside = (rows >= 0) & (rows < marked.shape[0]) & (cols >= 0) & (cols < marked.shape[1])
        marked[rows[inside], cols[inside]] = True
    return marked


def _cells(panorama: Panorama, ranges_m: Array, where: NDArray[np.bool_]) -> Iterable[Cell]:
    """Each cell once that ranges in some of the directions end in."""
    r, angle = ranges_m[where], panorama.bearings[where]
    xy = panorama.center_xy + np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    return {(x, y) for x, y in np.floor(xy / CELL_M).astype(int).tolist()}


def _around(points_xy: Array, reach_m: float) -> set[Cell]:
    """Cells whose middle lies within a reach of any of the points."""
    n = int(np.ceil(reach_m / CELL_M))
    steps = np.stack(np.meshgrid(np.arange(-n, n + 1), np.arange(-n, n + 1)), -1).reshape(-1, 2)
    steps = steps[np.hypot(steps[:, 0], steps[:, 1]) * CELL_M <= reach_m]
    cells = np.floor(points_xy / CELL_M).astype(int)[:, None] + steps
    return {(x, y) for x, y in cells.reshape(-1, 2).tolist()}
