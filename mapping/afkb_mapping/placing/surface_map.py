"""The map of upright surface that views are matched to, seen from above, m."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.placing.scan_surface import RANGE_SIGMA_M, SurfacePoints

Array = NDArray[np.float64]

CELL_M = 0.05
"""Cell within which the map averages points: about the beam spacing at 5 m, below a wall's depth"""
TILE_M = 1.0
"""Rows are found by tiles of this width, so that what is far away costs nothing."""
LEAST_WEIGHT = 1e-6
"""Below any point's: what is left of a cell, by rounding, when all of its points were taken out."""


class SurfaceMap:
    """Surface points of all views so far, averaged per cell, side and layer; grows with the area.

    A row of `_sums` holds weighted sums of x, y, normal and sigma, the weight, and the layer.
    """

    def __init__(self) -> None:
        self._index: dict[tuple[int, ...], int] = {}
        self._tiles: dict[tuple[int, int], list[int]] = {}
        self._sums = np.zeros((1024, 6))
        self._level = np.zeros(1024, np.intp)

    def __len__(self) -> int:
        return len(self._index)

    def add(self, surface: SurfacePoints) -> None:
        """Average in a view's points, given in the map frame; surer points count for more."""
        self._count(surface, 1.0)

    def remove(self, surface: SurfacePoints) -> None:
        """Take out what was added before, point for point."""
        self._count(surface, -1.0)

    def _count(self, surface: SurfacePoints, times: float) -> None:
        rows = self._rows_of(surface)
        weights = times * (RANGE_SIGMA_M / surface.sigma_m)[:, None] ** 2
        values = np.column_stack([surface.points_xy, surface.normals_xy, surface.sigma_m])
        np.add.at(self._sums, rows, np.column_stack([values * weights, weights]))
        self._level[rows] = surface.level

    def _rows_of(self, surface: SurfacePoints) -> NDArray[np.intp]:
        """Row of each point's cell; both sides of a thin wall have rows of their own."""
        index, known = self._index, len(self._index)
        keys = zip(*_cells(surface, CELL_M).T.tolist(), strict=True)
        rows = np.array([index.setdefault(key, len(index)) for key in keys], dtype=np.intp)
        while len(index) > len(self._sums):
            self._sums = np.concatenate([self._sums, np.zeros_like(self._sums)])
            self._level = np.concatenate([self._level, np.zeros_like(self._level)])
        new, first = np.unique(rows, return_index=True)
        tiles = np.floor(surface.points_xy[first] / TILE_M).astype(np.int64).tolist()
        for row, (x, y) in zip(new.tolist(), tiles, strict=True):
            if row >= known:
                self._tiles.setdefault((x, y), []).append(row)
        return rows

    def near(self, center_xy: Array, radius_m: float) -> SurfacePoints:
        """The map's points within a radius: what a view taken there can see."""
        low = np.floor((center_xy - radius_m) / TILE_M).astype(int)
        high = np.floor((center_xy + radius_m) / TILE_M).astype(int) + 1
        tiles = itertools.product(range(low[0], high[0]), range(low[1], high[1]))
        rows = np.sort(np.array([r for t in tiles for r in self._tiles.get(t, ())], dtype=np.intp))
        return self._at(rows).near(center_xy, radius_m)

    def all(self) -> SurfacePoints:
        """All of the map's points."""
        return self._at(np.arange(len(self._index)))

    def _at(self, rows: NDArray[np.intp]) -> SurfacePoints:
        rows = rows[self._sums[rows, 5] > LEAST_WEIGHT]
        mean = self._sums[rows, :5] / self._sums[rows, 5:]
        length = np.linalg.norm(mean[:, 2:4], axis=1, keepdims=True)
        normals = mean[:, 2:4] / np.maximum(length, 1e-9)
        return SurfacePoints(mean[:, :2], normals, self._level[rows], mean[:, 4])


def thinned(surface: SurfacePoints) -> SurfacePoints:
    """One point per cell, side and layer: a thing nearby has no more of a say than a wall afar."""
    if not len(surface):
        return surface
    _, row, count = np.unique(
        _cells(surface, CELL_M), axis=0, return_inverse=True, return_counts=True
    )
    values = np.column_stack([surface.points_xy, surface.normals_xy, surface.sigma_m])
    sums = np.zeros((len(count), 5))
    np.add.at(sums, row.ravel(), values)
    mean = sums / count[:, None]
    level = np.zeros(len(count), np.intp)
    level[row.ravel()] = surface.level
    normals = mean[:, 2:4] / np.linalg.norm(mean[:, 2:4], axis=1, keepdims=True)
    return SurfacePoints(mean[:, :2], normals, level, mean[:, 4])


def _cells(surface: SurfacePoints, cell_m: float) -> NDArray[np.int64]:
    """(N, 4) cell, side (which quarter it faces) and layer of each point."""
    cells = np.floor(surface.points_xy / cell_m).astype(np.int64)
    facing = np.arctan2(surface.normals_xy[:, 1], surface.normals_xy[:, 0])
    side = np.round(facing / (np.pi / 2)).astype(np.int64) % 4
    return np.column_stack([cells, side, surface.level])
