"""Occupancy in three dimensions from depth images: slabs of height above cells of the floor."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.grid.occupancy import MARGIN_M, MOST_CELLS
from afkb_mapping.grid.occupancy import RESOLUTION_M as CELL_M
from afkb_mapping.kernels import kernel

Array = NDArray[np.float64]

SLAB_M = 0.05
"""Thin enough to see over a table top from a camera that is a hand's breadth above it."""
SLABS = 40
"""Up to 2 m: what robots that drive on floors see of a home."""
TRUSTED_M = 5.0
"""Further away depth is wrong by a cell."""
STEP_PX = 65.0
"""Focal length (px) over this: every so many pixels are read, 4 cm apart at `TRUSTED_M` / 2."""
UNSEEN, OCCUPIED_STEP, FREE_STEP, LIMIT = -128, 9, -4, 35
"""Tenths of the grid's log-odds (`occupancy`): a hit, a passing, and how far they add up."""
BEFORE_HIT_M = 0.08
"""A beam clears its way up to here before its end: a cell's diagonal."""


class SlabBuilder:
    """Log-odds of cells (rows, cols, SLABS), int8, in tenths; `UNSEEN` where nothing was seen.

    Each changes once a view at most, and a hit beats a passing, as in `occupancy.GridBuilder`.
    """

    def __init__(self) -> None:
        self._log_odds = np.zeros((0, 0, SLABS), np.int8)
        self._first_cell = np.zeros(2, np.int64)

    def insert(self, view: View) -> None:
        """Take in the depth of a placed view. Raises `BadFrame` where it lies absurdly far off."""
        assert view.depth_m is not None
        T = view.T_map_camera
        low = np.floor((T[:2, 3] - TRUSTED_M) / CELL_M).astype(np.int64) - 1
        size = math.ceil(2 * TRUSTED_M / CELL_M) + 3
        self._ensure(low, low + size)
        col, row = low - self._first_cell
        step = max(1, round(intrinsics_of(view)[0] / STEP_PX))
        verdict = np.zeros((size, size, SLABS), np.int8)
        corner_xy = np.asarray(low * CELL_M, np.float64)
        _trace(verdict, view.depth_m, intrinsics_of(view), T, corner_xy, step)
        _update(self._log_odds[row : row + size, col : col + size], verdict)

    def slabs(self) -> tuple[NDArray[np.int8], NDArray[np.int64]]:
        """States (rows, cols, SLABS) as `bands` has them, cut to what was seen; the first cell.

        The first cell (2,) counts columns and rows from the origin of the map.
        """
        seen = (self._log_odds != UNSEEN).any(axis=2)
        rows, cols = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
        if not len(rows):
            return np.full((1, 1, SLABS), -1, np.int8), np.zeros(2, np.int64)
        part = self._log_odds[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
        states = np.where(part == UNSEEN, -1, part > 0).astype(np.int8)
        return states, self._first_cell + np.array([cols[0], rows[0]])

    def _ensure(self, low: NDArray[np.int64], high: NDArray[np.int64]) -> None:
        """Grow so that cells from `low` to before `high` (column, row) are there."""
        size = np.array(self._log_odds.shape[1::-1])
        if size.all():
            if (low >= self._first_cell).all() and (high <= self._first_cell + size).all():
                return
            low = np.minimum(low, self._first_cell)
            high = np.maximum(high, self._first_cell + size)
        margin = math.ceil(MARGIN_M / CELL_M)
        low, high = low - margin, high + margin
        cols, rows = (int(n) for n in high - low)
        if cols * rows > MOST_CELLS:
            raise BadFrame("the map would be far too large: its pose or its depth can't be right")
        grown = np.full((rows, cols, SLABS), UNSEEN, np.int8)
        if size.all():
            c, r = (int(n) for n in self._first_cell - low)
            grown[r : r + int(size[1]), c : c + int(size[0])] = self._log_odds
        self._log_odds, self._first_cell = grown, low


@kernel
def _trace(
    verdict: NDArray[np.int8],
    depth_m: NDArray[np.float32],
    intrinsics: Array,
    T: Array,
    corner_xy: Array,
    step: int,
) -> None:
    """Mark cells that pixels look through with -1, and those where they end with 1, which stays."""
    fx, fy, cx, cy = intrinsics
    start = np.array([(T[0, 3] - corner_xy[0]) / CELL_M, (T[1, 3] - corner_xy[1]) / CELL_M])
    for v in range(0, depth_m.shape[0], step):
        for u in range(0, depth_m.shape[1], step):
            d = float(depth_m[v, u])
            if not d > 0.0:
                continue
            xc, yc = (u - cx) / fx, (v - cy) / fy
            wx = d * (T[0, 0] * xc + T[0, 1] * yc + T[0, 2])
            wy = d * (T[1, 0] * xc + T[1, 1] * yc + T[1, 2])
            wz = d * (T[2, 0] * xc + T[2, 1] * yc + T[2, 2])
            r = math.sqrt(wx * wx + wy * wy + wz * wz)
            near = min(1.0, TRUSTED_M / r)
            steps = int((r * near - BEFORE_HIT_M) / CELL_M)
            for k in range(steps):
                t = k * CELL_M / r
                h = T[2, 3] + wz * t
                if h <= 0.0:
                    break
                s = int(h / SLAB_M)
                if s >= SLABS:
                    continue
                i, j = int(start[1] + wy * t / CELL_M), int(start[0] + wx * t / CELL_M)
                if verdict[i, j, s] == 0:
                    verdict[i, j, s] = -1
            s = math.floor((T[2, 3] + wz) / SLAB_M)
            if near == 1.0 and 0 <= s < SLABS:
                verdict[int(start[1] + wy / CELL_M), int(start[0] + wx / CELL_M), s] = 1


@kernel
def _update(log_odds: NDArray[np.int8], verdict: NDArray[np.int8]) -> None:
    """One observation for each cell (rows, cols, SLABS)."""
    for i in range(log_odds.shape[0]):
        for j in range(log_odds.shape[1]):
            for s in range(log_odds.shape[2]):
                if verdict[i, j, s] == 0:
                    continue
                before = 0 if log_odds[i, j, s] == UNSEEN else log_odds[i, j, s]
                after = before + (OCCUPIED_STEP if verdict[i, j, s] > 0 else FREE_STEP)
                log_odds[i, j, s] = min(max(after, -LIMIT), LIMIT)
