"""Whether bounds still stand: time wears their existence, and so do beams that pass there now."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Bound, Doorway, OccupancyGrid
from afkb.inference.update_rules import CERTAIN
from afkb_mapping.visits.persistence import MOST_STEADFAST, aged, hazard_of

Array = NDArray[np.float64]

OCCUPIED_FROM = 0.5
INNER = 0.7
"""So much of a doorway's width, its jambs left out, is asked for whether it is open."""


def bound_now(bound: Bound, grid: OccupancyGrid, now: float) -> Bound:
    """The bound with the probability that it still stands, at `now`, s, the map's clock.

    The share of its length that the grid still holds for occupied, worn by the time since a view
    last showed it, at the rate of what never moves by itself: the ontology states no movability of
    walls. The front of furniture and the leaf of a door go by the beams that pass there later.
    """
    since = max(now - bound.last_seen, 0.0)
    p = aged(_share_standing(bound, grid), since, hazard_of(MOST_STEADFAST))
    return replace(bound, existence=float(np.clip(p, 1 - CERTAIN, CERTAIN)))


def doorway_now(doorway: Doorway, grid: OccupancyGrid) -> Doorway:
    """The doorway with the probability that it is open: the share of it that is not occupied now.

    A door that was open at one visit and is shut at the next goes by the beams that end on it.
    """
    across = doorway.width / 2 * np.array([-np.sin(doorway.yaw), np.cos(doorway.yaw)])
    middle = np.array([doorway.x, doorway.y])
    cells = _cells(middle - INNER * across, middle + INNER * across, grid)
    rows, cols = grid.probability.shape
    inside = [(row, col) for col, row in cells.tolist() if 0 <= row < rows and 0 <= col < cols]
    p = np.array([grid.probability[at] for at in inside])
    open_ = float((p[~np.isnan(p)] < OCCUPIED_FROM).mean()) if (~np.isnan(p)).any() else 1.0
    return replace(doorway, existence=float(np.clip(open_, 1 - CERTAIN, CERTAIN)))


def _cells(start: Array, end: Array, grid: OccupancyGrid) -> NDArray[np.int64]:
    """(N, 2) columns and rows of the cells along a line between two points (2,), m."""
    steps = max(2, round(float(np.linalg.norm(end - start)) / grid.resolution_m) + 1)
    along = start + np.linspace(0.0, 1.0, steps)[:, None] * (end - start)
    return np.floor((along - grid.origin_xy) / grid.resolution_m).astype(np.int64)


def _share_standing(bound: Bound, grid: OccupancyGrid) -> float:
    """Of its cells that are known, the share that is occupied, or beside one that is: 0..1."""
    cells = _cells(np.asarray(bound.start_xy), np.asarray(bound.end_xy), grid)
    near = np.array([_highest(grid.probability, row, col) for col, row in cells.tolist()])
    known = near[near >= 0]
    return float((known >= OCCUPIED_FROM).mean()) if len(known) else 1.0


def _highest(probability: NDArray[np.floating], row: int, col: int) -> float:
    """Of a cell and those around it; -1 where none is known."""
    around = probability[max(row - 1, 0) : max(row + 2, 0), max(col - 1, 0) : max(col + 2, 0)]
    return float(np.nan_to_num(around, nan=-1.0).max(initial=-1.0))
