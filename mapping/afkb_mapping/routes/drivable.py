"""Where the middle of a round robot may be: the free cells of the grid, shrunk by its radius."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.store.stored_grid import StoredGrid

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Cell = tuple[int, int]

AVOID = 5.0
"""A metre past something that is there with probability p counts as 1 + 5 p metres: to go round it
by two and a half times the way is worth it for what is there every other time."""


@dataclass(frozen=True, slots=True, eq=False)
class Drivable:
    """Cells of the plan, as the robot's middle may use them.

    - `clearance_m` (rows, cols): from a cell's middle to the next cell that is occupied or unknown.
    - `free`: clearance of at least `radius_m`. `weight`: what a metre there counts as, 1 or more.
    - Cell (0, 0) has its lower left corner at `origin_xy`, m, map frame; rows run along +y.
    """

    clearance_m: NDArray[np.float32]
    free: Mask
    weight: NDArray[np.float32]
    radius_m: float
    resolution_m: float
    origin_xy: Array

    def cell(self, xy: Array) -> Cell | None:
        """Row and column of a point (2,), m, or None outside the grid."""
        col, row = np.floor((xy - self.origin_xy) / self.resolution_m).astype(int)
        inside = 0 <= row < self.free.shape[0] and 0 <= col < self.free.shape[1]
        return (int(row), int(col)) if inside else None

    def middles(self, cells: NDArray[np.intp]) -> Array:
        """(N, 2) middles, m, of cells (N, 2) given by row and column."""
        middles: Array = self.origin_xy + (cells[:, ::-1] + 0.5) * self.resolution_m
        return middles

    def nearest(self, xy: Array, within_m: float) -> Cell | None:
        """The free cell nearest to a point (2,), m, or None if there is none within a distance."""
        reach = math.ceil(within_m / self.resolution_m) + 1
        col, row = np.floor((xy - self.origin_xy) / self.resolution_m).astype(int)
        low = np.maximum([row - reach, col - reach], 0)
        high = np.maximum([row + reach + 1, col + reach + 1], 0)
        cells = np.argwhere(self.free[low[0] : high[0], low[1] : high[1]]) + low
        if not len(cells):
            return None
        off = np.hypot(*(self.middles(cells) - xy).T)
        best = int(off.argmin())
        return (int(cells[best, 0]), int(cells[best, 1])) if off[best] <= within_m else None


def drivable(stored: StoredGrid, radius_m: float, passable: Mask | None = None) -> Drivable:
    """Where a robot of a radius, m, may drive; what is unknown is not free.

    Cells between the grid's thresholds, where a dynamic or a doubtful thing is, may be driven over,
    at a cost by their probability. `passable`: occupied cells that are to be treated so, too.
    """
    grid = stored.grid
    p = np.nan_to_num(grid.probability, nan=1.0)
    blocked = p > stored.occupied_above
    if passable is not None:
        blocked &= ~passable
    # Outside of the array nothing is known.
    distance = ndimage.distance_transform_edt(np.pad(~blocked, 1))[1:-1, 1:-1]
    clearance = np.asarray((distance - 0.5) * grid.resolution_m, dtype=np.float32)
    free = ~blocked & (clearance >= radius_m - 1e-6)
    doubtful = np.where(~blocked & (p >= stored.free_below), p, np.float32(0.0))
    weight = (1 + AVOID * _spread(doubtful, radius_m / grid.resolution_m)).astype(np.float32)
    return Drivable(
        clearance, free, weight, radius_m, grid.resolution_m, np.asarray(grid.origin_xy, np.float64)
    )


def _spread(probability: NDArray[np.float32], reach: float) -> NDArray[np.float32]:
    """The greatest probability within reach of each cell, in cells: what the robot's rim meets."""
    import cv2

    n = math.floor(reach)
    steps = np.arange(-n, n + 1)
    disc = (np.hypot(steps[:, None], steps[None]) <= max(reach, 0.5)).astype(np.uint8)
    return np.asarray(cv2.dilate(probability.astype(np.float32), disc), dtype=np.float32)
