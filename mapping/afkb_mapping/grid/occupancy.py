"""The occupancy grid O: log-odds of cells from laser beams and depth (paper §II.E).

The inverse sensor model is that of Thrun, Burgard and Fox, Probabilistic Robotics, ch. 9: a beam
says "free" along its way and "occupied" where it ends.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import OccupancyGrid, View
from afkb_mapping.geometry import transform_xy

RESOLUTION_M = 0.05
"""Cell size: what nav2 and the floor plans of the field use."""
LOG_ODDS_OCCUPIED = 0.85
"""A beam's end is in an occupied cell with probability 0.70: the rest is pose and angle error."""
LOG_ODDS_FREE = -0.4
"""A cell that a beam passes is free with probability 0.60; less, as beams graze corners."""
LOG_ODDS_LIMIT = 3.5
"""Clamp (probability 0.03 to 0.97), so that what is moved away is gone after some ten looks."""
MAX_FREE_RANGE_M = 15.0
"""Beams clear cells up to here: further off, the angle between beams leaves gaps anyway."""
HALF_DOORWAY_M = 0.55
"""Half the width of a wide single door with its frame, and room to stand before it."""
MOST_CELLS = 40_000_000
"""What fits into the memory that a run may take: 500 m x 200 m at 5 cm."""
MARGIN_M = 5.0
"""The array grows by at least this much, and a quarter of its size, so that growing is rare."""

Points = NDArray[np.float64]


class GridBuilder:
    """Builds the grid view by view; the array grows with what is seen, the origin in whole cells.

    Each cell changes once per view at most, and a hit beats a miss: two hundred beams of one view
    that graze the same cell are one observation.
    """

    def __init__(self, resolution: float = RESOLUTION_M) -> None:
        self._resolution = resolution
        self._log_odds = np.zeros((0, 0), dtype=np.float32)
        self._seen = np.zeros((0, 0), dtype=bool)
        self._first_cell = np.zeros(2, dtype=np.int64)

    def insert_scan(self, view: View) -> None:
        """Take in the laser scan of a placed view; beams without a return clear nothing.

        A missing return may be glass, a black sofa or open space: it is no evidence for either.
        """
        if view.scan is None:
            raise BadFrame("insert_scan: this view has no laser scan")
        T_map_laser = view.T_map_laser
        ends = transform_xy(T_map_laser, view.scan.points_xy)
        self.insert_beams(T_map_laser[:2, 3], ends, np.ones(len(ends), dtype=bool))

    def insert_depth_obstacles(
        self, obstacles_xy: Points, sensor_xy: Points, floor_xy: Points | None = None
    ) -> None:
        """Take in a depth view seen from above, where there is no laser.

        - `obstacles_xy` (N, 2): ends of pixels 0.1 to 1.5 m above the floor, m, map frame.
        - `floor_xy` (M, 2): floor pixels. They are free themselves, and say nothing about the way
          to them: the camera may have looked at them over a table.
        """
        obstacles = np.asarray(obstacles_xy, dtype=np.float64).reshape(-1, 2)
        if floor_xy is None:
            self.insert_beams(sensor_xy, obstacles, np.ones(len(obstacles), dtype=bool))
            return
        floor = np.asarray(floor_xy, dtype=np.float64).reshape(-1, 2)
        points = np.concatenate([obstacles, floor])
        if not len(points):
            return
        part = self._window(points)
        verdict = np.zeros(self._log_odds[part].shape, dtype=np.int8)
        for cells, value in ((floor, -1), (obstacles, 1)):
            cols, rows = (self._cells(cells) - (part[1].start, part[0].start)).T
            verdict[rows, cols] = value
        self._apply(verdict, part)

    def insert_beams(self, sensor_xy: Points, ends_xy: Points, hit: NDArray[np.bool_]) -> None:
        """Take in beams from a sensor (2,) to their ends (N, 2), m, map frame.

        Each clears its way; where it ends stands something, if `hit` (N,).
        """
        from afkb_mapping.grid.rays import trace_beams

        if not len(ends_xy):
            return
        sensor = np.asarray(sensor_xy, dtype=np.float64)
        ends, hit = _shortened(sensor, ends_xy, hit)
        part = self._window(np.concatenate([ends, sensor[None]]))
        verdict = np.zeros(self._log_odds[part].shape, dtype=np.int8)
        trace_beams(verdict, self._within(sensor[None], part)[0], self._within(ends, part), hit)
        self._apply(verdict, part)

    def _within(self, points_xy: Points, part: tuple[slice, slice]) -> Points:
        """Points (N, 2) in cells of the window; rounding moves none to the next cell or out."""
        corner = np.array([part[1].start, part[0].start])
        cells = self._cells(points_xy) - corner
        shifted = points_xy / self._resolution - (self._first_cell + corner)
        kept: Points = np.clip(shifted, cells, np.nextafter(cells + 1.0, 0.0))
        return kept

    def _apply(self, verdict: NDArray[np.int8], part: tuple[slice, slice]) -> None:
        """One observation per cell: 1 occupied, -1 free, 0 not seen."""
        update = np.array([0.0, LOG_ODDS_OCCUPIED, LOG_ODDS_FREE], dtype=np.float32)[verdict]
        self._seen[part] |= verdict != 0
        summed = self._log_odds[part] + update
        self._log_odds[part] = np.clip(summed, -LOG_ODDS_LIMIT, LOG_ODDS_LIMIT)

    def _cells(self, points_xy: Points) -> NDArray[np.int64]:
        """(N, 2) column and row of each point in the array."""
        return np.floor(points_xy / self._resolution).astype(np.int64) - self._first_cell

    def _window(self, points_xy: Points) -> tuple[slice, slice]:
        """Rows and columns that the points span, after growing the array to hold them."""
        self._ensure(points_xy)
        cells = self._cells(points_xy)
        low, high = cells.min(axis=0), cells.max(axis=0) + 1
        return slice(int(low[1]), int(high[1])), slice(int(low[0]), int(high[0]))

    def _ensure(self, points_xy: Points) -> None:
        """Grow the array where a point lies outside it."""
        cells = np.floor(points_xy / self._resolution).astype(np.int64)
        low, high = cells.min(axis=0), cells.max(axis=0) + 1
        size = np.array(self._log_odds.shape[::-1], dtype=np.int64)
        if size.any():
            if (low >= self._first_cell).all() and (high <= self._first_cell + size).all():
                return
            low = np.minimum(low, self._first_cell)
            high = np.maximum(high, self._first_cell + size)
        least = math.ceil(MARGIN_M / self._resolution)
        # In proportion to what there is: the copies of all growing cost no more than the map.
        margin = np.maximum(least, size // 4) if size.any() else np.array([least, least])
        low, high = low - margin, high + margin
        cols, rows = (int(n) for n in high - low)
        if cols * rows > MOST_CELLS:
            extent = " x ".join(f"{n * self._resolution:.3g}" for n in (cols, rows))
            raise BadFrame(f"the map would be {extent} m: its pose or its depth can't be right")
        log_odds = np.zeros((rows, cols), dtype=np.float32)
        seen = np.zeros((rows, cols), dtype=bool)
        if size.any():
            c, r = (int(n) for n in self._first_cell - low)
            inside = np.s_[r : r + int(size[1]), c : c + int(size[0])]
            log_odds[inside], seen[inside] = self._log_odds, self._seen
        self._log_odds, self._seen, self._first_cell = log_odds, seen, low

    def unknown(self, points_xy: Points) -> NDArray[np.bool_]:
        """(N,) for points (N, 2): whether nothing has been seen in their cells yet."""
        return ~(self._at(points_xy, self._seen) > 0)

    def occupied(self, points_xy: Points) -> NDArray[np.bool_]:
        """(N,) for points (N, 2): whether their cells are more likely occupied than free."""
        return self._at(points_xy, self._log_odds) > 0

    def in_sight(self, start_xy: tuple[float, float], end_xy: Points) -> bool:
        """Whether nothing that was seen stands on the straight line between two points (m)."""
        start = np.asarray(start_xy, dtype=np.float64)
        steps = max(2, math.ceil(float(np.linalg.norm(end_xy - start)) / self._resolution))
        line = start + np.linspace(0, 1, steps)[:, None] * (end_xy - start)
        return not self.occupied(line).any()

    def doorway_between(self, start_xy: tuple[float, float], end_xy: Points) -> bool:
        """Whether the straight line between two points (m) squeezes through a passage.

        Something stands within `HALF_DOORWAY_M` on either side of it. Not counted is what is that
        near to its ends: who stands in a doorway has not passed it.
        """
        start = np.asarray(start_xy, dtype=np.float64)
        length = float(np.linalg.norm(end_xy - start))
        if length <= 2 * HALF_DOORWAY_M:
            return False
        along = (end_xy - start) / length
        left = np.array([-along[1], along[0]])
        way = np.arange(HALF_DOORWAY_M, length - HALF_DOORWAY_M, self._resolution)
        aside = np.arange(self._resolution, HALF_DOORWAY_M, self._resolution)
        line = start + way[:, None] * along
        sides = [
            self.occupied((line[:, None] + sign * aside[:, None] * left).reshape(-1, 2))
            .reshape(len(way), len(aside))
            .any(axis=1)
            for sign in (1.0, -1.0)
        ]
        return bool((sides[0] & sides[1]).any())

    def _at(
        self, points_xy: Points, values: NDArray[np.float32] | NDArray[np.bool_]
    ) -> NDArray[np.float32]:
        """(N,) values of the cells that points are in, 0 outside of the array."""
        cells = self._cells(points_xy)
        inside = ((cells >= 0) & (cells < values.shape[::-1])).all(axis=1)
        found = np.zeros(len(points_xy), dtype=np.float32)
        cols, rows = cells[inside].T
        found[inside] = values[rows, cols]
        return found

    def grid(self) -> OccupancyGrid:
        """The grid so far, cut to what was seen; one unknown cell where nothing was."""
        rows, cols = np.flatnonzero(self._seen.any(axis=1)), np.flatnonzero(self._seen.any(axis=0))
        if not len(rows):
            return OccupancyGrid(np.full((1, 1), np.nan, np.float32), self._resolution, (0.0, 0.0))
        part = np.s_[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
        log_odds = np.where(self._seen[part], self._log_odds[part], np.float32(np.nan))
        probability = (1 / (1 + np.exp(-log_odds))).astype(np.float32)
        x, y = (self._first_cell + np.array([cols[0], rows[0]])) * self._resolution
        origin = (round(float(x), 6), round(float(y), 6))
        return OccupancyGrid(probability, self._resolution, origin)


def _shortened(
    sensor: Points, ends: Points, hit: NDArray[np.bool_]
) -> tuple[Points, NDArray[np.bool_]]:
    """Beams cut at `MAX_FREE_RANGE_M`; a cut beam clears, but hits nothing."""
    offsets = ends - sensor
    lengths = np.linalg.norm(offsets, axis=1)
    long = lengths > MAX_FREE_RANGE_M
    scale = np.where(long, MAX_FREE_RANGE_M / np.maximum(lengths, 1e-9), 1.0)
    return sensor + offsets * scale[:, None], hit & ~long


def rasterise(grid: OccupancyGrid, polygon_xy: Points, probability: float) -> OccupancyGrid:
    """The grid with a thing drawn into it: each cell at least as occupied as the thing is likely.

    For predicted and dynamic things (DESIGN §2: predicted things fill the grid too).
    `polygon_xy` (N, 2), m, map frame; unknown cells under it become known. The grid grows if the
    thing reaches beyond it.
    """
    if not 0 <= probability <= 1:
        raise ValueError(f"probability {probability} is not in 0..1")
    return rasterised(grid, [(polygon_xy, probability)])


def rasterised(grid: OccupancyGrid, things: Sequence[tuple[Points, float]]) -> OccupancyGrid:
    """The grid with all of these polygons (N, 2), m, drawn into it, as `rasterise` draws one."""
    import cv2

    if not things:
        return grid
    grid = _grown(grid, np.concatenate([np.asarray(polygon, np.float64) for polygon, _ in things]))
    cells = grid.probability.copy()
    for polygon_xy, probability in things:
        corners = (np.asarray(polygon_xy) - grid.origin_xy) / grid.resolution_m - 0.5
        low = np.maximum(np.floor(corners.min(axis=0)).astype(int) - 1, 0)
        high = np.ceil(corners.max(axis=0)).astype(int) + 2
        part = cells[low[1] : high[1], low[0] : high[0]]
        mask = np.zeros(part.shape, dtype=np.uint8)
        shift = 8
        fixed = np.round((corners - low) * (1 << shift)).astype(np.int32)
        cv2.fillPoly(mask, [fixed], 1, shift=shift)
        part[mask > 0] = np.fmax(part, np.float32(probability))[mask > 0]
    return OccupancyGrid(cells, grid.resolution_m, grid.origin_xy)


def _grown(grid: OccupancyGrid, points_xy: Points) -> OccupancyGrid:
    """The grid with unknown cells added so that it covers the points."""
    resolution, origin = grid.resolution_m, np.array(grid.origin_xy)
    rows, cols = grid.probability.shape
    low = np.floor((points_xy.min(axis=0) - origin) / resolution).astype(int)
    high = np.floor((points_xy.max(axis=0) - origin) / resolution).astype(int) + 1
    left, below = (max(0, -int(n)) for n in low)
    right, above = max(0, int(high[0]) - cols), max(0, int(high[1]) - rows)
    if not (left or below or right or above):
        return grid
    padded = np.pad(grid.probability, ((below, above), (left, right)), constant_values=np.nan)
    x, y = origin - np.array([left, below]) * resolution
    return OccupancyGrid(padded, resolution, (round(float(x), 6), round(float(y), 6)))
