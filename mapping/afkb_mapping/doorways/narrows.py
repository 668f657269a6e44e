"""Narrow places of a grid: where standing things come nearest to each other across free floor.

One depth image seldom shows both jambs of a doorway, and what is behind. The map has them all: what
views have seen to stand, and floor that they have seen to be free. A doorway is where two edges of
standing things are nearest to each other, nearer than to either side.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways.detour import is_narrow
from afkb_mapping.doorways.gaps import SAME_M, SAME_RAD
from afkb_mapping.grid.straight_runs import runs_m
from afkb_mapping.kernels import kernel
from afkb_mapping.trapezoids import Limits, membership, ramp

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.intp]

JAMB_M = 0.25
"""A jamb is nearer to the other one than anything beside it within this is: of a door's frame, and
of the rounded end of what noise makes of a wall."""
BEYOND_M = 0.6
"""So far before and behind it must be free: room for a robot or a person to get through,"""
BEYOND_SHARE = (0.5, 0.7)
"""or as good as free: below the first share of its cells nothing leads on, from the second it does.
"""
SURE = 0.97
JAMB_LENGTH_M = (0.1, 0.4)
"""What runs as straight beside the gap as the second is a wall's end; the first is a leg or a post.
"""
STRIP, STRIP_STEP_M = np.linspace(0.2, 0.8, 7), 0.1
"""Where this is looked at: at these parts of the width, and every so far from the line."""


def gaps_of_map(
    free: Mask, standing: Mask, grid: OccupancyGrid, width_m: Limits
) -> Iterator[tuple[Array, float]]:
    """Jambs (2, 2), m, map frame, of each narrow place, and how much of a passage it looks like.

    `free`, `standing`: (rows, cols) of the grid, where the floor was seen, and where things stand;
    `width_m`: trapezoid of how wide passages are.
    """
    for jambs in narrow_places(free, standing, grid, width_m[0], width_m[3]):
        p = SURE * membership(math.dist(*jambs.tolist()), width_m)
        for length in runs_m(standing, jambs, grid):
            p *= ramp(length, JAMB_LENGTH_M)
        if p > 0:
            yield jambs, p * leads_on(jambs, free, grid)


def narrow_places(
    free: Mask, standing: Mask, grid: OccupancyGrid, narrowest_m: float, widest_m: float
) -> list[Array]:
    """Pairs of jambs (2, 2), m, map frame, the narrowest first."""
    edge = standing & ndimage.binary_dilation(free, np.ones((3, 3), dtype=bool))
    limits = np.array([narrowest_m, widest_m, JAMB_M]) / grid.resolution_m
    cells = _nearest_pairs(free, edge, *(limits - [1.0, 1.0, 0.0]))
    order = np.argsort(np.hypot(*(cells[:, 2:] - cells[:, :2]).T), kind="stable")
    middles = cells[order].reshape(-1, 2, 2)[..., ::-1] + 0.5
    spans = middles[:, 1] - middles[:, 0]
    # Noise spreads an edge over cells, of which the nearest are half a cell before it.
    half = spans / np.linalg.norm(spans, axis=1, keepdims=True) / 2
    jambs = np.stack([middles[:, 0] - half, middles[:, 1] + half], axis=1)
    placed = jambs * grid.resolution_m + np.array(grid.origin_xy)
    return [j for j in _one_a_place(placed) if is_narrow(j, free, grid)]


def leads_on(jambs_xy: Array, free: Mask, grid: OccupancyGrid) -> float:
    """How far both sides of a narrow place are free to pass, 0 to 1."""
    along = jambs_xy[1] - jambs_xy[0]
    normal = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    off = np.arange(STRIP_STEP_M, BEYOND_M + STRIP_STEP_M / 2, STRIP_STEP_M)
    line = jambs_xy[0] + np.outer(STRIP, along)
    shares = []
    for sign in (-1, 1):
        points = (line[:, None] + sign * off[:, None] * normal).reshape(-1, 2)
        cells = np.floor((points - grid.origin_xy) / grid.resolution_m).astype(int)
        inside = ((cells >= 0) & (cells < free.shape[::-1])).all(axis=1)
        cols, rows = cells[inside].T
        shares.append(float(free[rows, cols].sum()) / len(points))
    return ramp(min(shares), BEYOND_SHARE)


def _one_a_place(jambs: Array) -> Iterator[Array]:
    """Of jambs (N, 2, 2), narrowest first, those that are of no narrower place."""
    same = math.cos(SAME_RAD)
    middles, spans = jambs.mean(axis=1), jambs[:, 1] - jambs[:, 0]
    directions = spans / np.linalg.norm(spans, axis=1, keepdims=True)
    left = np.ones(len(jambs), dtype=bool)
    for k in range(len(jambs)):
        if left[k]:
            yield jambs[k]
            near = np.linalg.norm(middles - middles[k], axis=1) < SAME_M
            left &= ~(near & (np.abs(directions @ directions[k]) > same))


@kernel
def _nearest_pairs(free: Mask, edge: Mask, least: float, most: float, jamb: float) -> Index:
    """(N, 4) row and column of two edge cells: a clear line apart, and nearest to each other."""
    rows, cols = edge.shape
    reach = int(most)
    found = np.empty((64, 4), np.intp)
    n = 0
    for r0 in range(rows):
        for c0 in range(cols):
            if not edge[r0, c0]:
                continue
            for r1 in range(r0, min(rows, r0 + reach + 1)):
                for c1 in range(max(0, c0 - reach), min(cols, c0 + reach + 1)):
                    if not edge[r1, c1] or (r1 == r0 and c1 <= c0):
                        continue
                    if not least <= math.hypot(r1 - r0, c1 - c0) <= most:
                        continue
                    if _nearer(edge, r0, c0, r1, c1, jamb) or _nearer(edge, r1, c1, r0, c0, jamb):
                        continue
                    if not _is_clear(free, r0, c0, r1, c1):
                        continue
                    if n == len(found):
                        found = np.concatenate((found, np.empty_like(found)))
                    found[n, 0], found[n, 1], found[n, 2], found[n, 3] = r0, c0, r1, c1
                    n += 1
    return found[:n]


@kernel
def _nearer(edge: Mask, row: int, col: int, to_row: int, to_col: int, within: float) -> bool:
    """Whether an edge cell within so many cells of one is nearer to another than that one is."""
    n = int(within)
    off = (to_row - row) ** 2 + (to_col - col) ** 2
    for r in range(max(0, row - n), min(edge.shape[0], row + n + 1)):
        for c in range(max(0, col - n), min(edge.shape[1], col + n + 1)):
            if not edge[r, c] or (r - row) ** 2 + (c - col) ** 2 > within * within:
                continue
            if (to_row - r) ** 2 + (to_col - c) ** 2 < off:
                return True
    return False


@kernel
def _is_clear(free: Mask, r0: int, c0: int, r1: int, c1: int) -> bool:
    """Whether all cells between two are free, but for those that touch either."""
    n = 2 * max(abs(r1 - r0), abs(c1 - c0))
    for k in range(1, n):
        r = int(r0 + (r1 - r0) * k / n + 0.5)
        c = int(c0 + (c1 - c0) * k / n + 0.5)
        at_first = max(abs(r - r0), abs(c - c0)) <= 1
        at_second = max(abs(r - r1), abs(c - c1)) <= 1
        if not (free[r, c] or at_first or at_second):
            return False
    return True
