"""Shortest paths over free cells, from one cell to all others (Dijkstra, on eight neighbours)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from afkb_mapping.routes.drivable import Cell, Drivable
from afkb_mapping.routes.straight import shortened

Array = NDArray[np.float64]

STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))
"""To half of the neighbours; the others are the same edges seen from there."""
KEPT = 2
"""Starts of which the ways are kept: on a large plan each takes megabytes."""
NOWHERE = -9999
"""What scipy gives as the cell before the first one."""


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """Costs (N,) of the free cells from one of them, inf where no way leads, and the ways."""

    costs: Array
    before: NDArray[np.int32]


class GridPaths:
    """Paths between free cells of a plan, no longer than `limit_m`; the last answers are kept."""

    def __init__(self, where: Drivable, limit_m: float = math.inf) -> None:
        self._where, self._limit_m = where, limit_m
        self._cells = np.argwhere(where.free)
        self._numbers = np.full(where.free.shape, -1, dtype=np.int64)
        self._numbers[tuple(self._cells.T)] = np.arange(len(self._cells))
        self._graph = _graph(where, self._numbers, len(self._cells))
        self._reached: dict[int, Reached] = {}

    def cost(self, start: Cell, end: Cell) -> float:
        """What the best way between two free cells counts as, m; inf where there is none."""
        return float(self._from(start).costs[self._numbers[end]])

    def costs(self, start: Cell) -> Array:
        """(rows, cols) cost from a free cell, m; inf where no way leads or nothing is free."""
        found = np.full(self._numbers.shape, np.inf)
        found[tuple(self._cells.T)] = self._from(start).costs
        return found

    def path(self, start: Cell, end: Cell) -> Array | None:
        """Corners (N, 2), m, of the way between two free cells, pulled tight; None if no way."""
        reached, at = self._from(start), int(self._numbers[end])
        if not math.isfinite(reached.costs[at]):
            return None
        numbers = [at]
        while (at := int(reached.before[at])) != NOWHERE:
            numbers.append(at)
        return shortened(self._where, self._where.middles(self._cells[numbers[::-1]]))

    def nearest_of(self, cells: Sequence[Cell]) -> NDArray[np.int64]:
        """(rows, cols): index of the cell, of some, from which the way is shortest; else -1."""
        found = np.full(self._numbers.shape, -1, dtype=np.int64)
        if cells:
            sources = [int(self._numbers[cell]) for cell in cells]
            costs, _, source = csgraph.dijkstra(
                self._graph,
                directed=False,
                indices=sources,
                return_predecessors=True,
                min_only=True,
            )
            index = {number: i for i, number in enumerate(sources)}
            labels = [index.get(int(s), -1) for s in np.where(np.isfinite(costs), source, -1)]
            found[tuple(self._cells.T)] = labels
        return found

    def _from(self, start: Cell) -> Reached:
        number = int(self._numbers[start])
        if number not in self._reached:
            costs, before = csgraph.dijkstra(
                self._graph,
                directed=False,
                indices=number,
                return_predecessors=True,
                limit=self._limit_m,
            )
            while len(self._reached) >= KEPT:
                del self._reached[next(iter(self._reached))]
            self._reached[number] = Reached(costs, before)
        return self._reached[number]


def _graph(where: Drivable, numbers: NDArray[np.int64], n: int) -> sparse.csr_matrix:
    """Steps between neighbouring free cells; a diagonal one only where it cuts no corner."""
    rows, cols, costs = [], [], []
    free, weight = where.free, where.weight
    height, width = free.shape
    for down, right in STEPS:
        left = max(-right, 0)
        here = np.s_[0 : height - down, left : width - max(right, 0)]
        there = np.s_[down:height, left + right : width - max(right, 0) + right]
        both = free[here] & free[there]
        if down and right:
            both &= free[down:height, left : width - max(right, 0)]
            both &= free[0 : height - down, left + right : width - max(right, 0) + right]
        rows.append(numbers[here][both])
        cols.append(numbers[there][both])
        mean = (weight[here][both].astype(np.float64) + weight[there][both]) / 2
        costs.append(mean * math.hypot(down, right) * where.resolution_m)
    entries = np.concatenate(costs), (np.concatenate(rows), np.concatenate(cols))
    return sparse.csr_matrix(entries, shape=(n, n))
