"""Where a robot stands at a place, before a thing, or in a room."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.errors import RouteError
from afkb_mapping.routes.drivable import Cell, Drivable, Mask, drivable
from afkb_mapping.routes.ends import End, Kind, name_of
from afkb_mapping.routes.route_map import MappedRoom, RouteMap, Spot, Thing

Array = NDArray[np.float64]

SNAP_M = 0.5
"""Where a robot has stood, one of another width stands at most so far aside."""
REACH_M = 1.5
"""A thing is looked into, or taken, from this near at most: across a table."""
EDGE_M = 0.10
"""What the grid has within this of a thing's outline is the thing and not a wall."""


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """Where a robot may stand in a map, and what it sees from there."""

    known: RouteMap
    where: Drivable
    walls: Mask

    @classmethod
    def of(cls, known: RouteMap, where: Drivable) -> Standing:
        """Of a robot that may drive there."""
        return cls(known, where, walls_of(known))

    def start(self, end: End, name: str) -> Cell:
        """The free cell at which a route may start; raises `RouteError` where there is none."""
        if isinstance(end, Kind):
            raise RouteError(f"{name}: a route starts at a point, a node or a room")
        self.check(end, name)
        everywhere = np.where(self.where.free, 0.0, np.inf)
        known = np.where(self._driven_about(), 0.0, np.inf)
        cell = self.at(end, known) or self.at(end, everywhere)
        if cell is None:
            radius = self.where.radius_m
            raise RouteError(
                f"{name}: a robot of radius {radius:.2f} m can't stand at {name_of(end)}; "
                "take a smaller --robot-radius or another node"
            )
        return cell

    def at(self, end: End, costs: Array) -> Cell | None:
        """The free cell at an end of least cost (rows, cols), m; None where all cost infinitely."""
        if isinstance(end, Thing):
            return _before(end.polygon_xy, self.where, self.walls, costs)
        if isinstance(end, MappedRoom):
            places = [p.xy for p in self.known.places.values() if p.room == end.id]
            return self._best(places, costs) or self._best([end.xy], costs)
        return None if isinstance(end, Kind) else self._best([end.xy], costs)

    def _driven_about(self) -> Mask:
        """(rows, cols): free cells that hang together with a place where a robot has stood.

        What else is free is mostly a hollow in furniture.
        """
        parts, _ = ndimage.label(self.where.free, structure=np.ones((3, 3), dtype=int))
        places = [self.where.nearest(p.xy, SNAP_M) for p in self.known.places.values()]
        driven: Mask = np.isin(parts, [parts[cell] for cell in places if cell is not None])
        return driven

    def at_any_width(self, end: End) -> Cell | None:
        """Where a robot of no width would stand at an end."""
        where = drivable(self.known.grid, 0.0)
        costs = np.where(where.free, 0.0, np.inf)
        return Standing(self.known, where, self.walls).at(end, costs)

    def _best(self, points: list[Array], costs: Array) -> Cell | None:
        """The cheapest of the free cells nearest to points (2,), m, where the robot has stood."""
        cells = [self.where.nearest(xy, SNAP_M) for xy in points]
        found = [c for c in cells if c is not None and math.isfinite(costs[c])]
        return min(found, key=lambda c: (costs[c], c), default=None)

    def check(self, end: End, name: str) -> None:
        """Raise `RouteError` for a point that is in an obstacle, or of which nothing is known."""
        if not isinstance(end, Spot) or end.id in self.known.places:
            return
        cell = self.where.cell(end.xy)
        p = self.known.grid.grid.probability[cell] if cell else np.nan
        if np.isnan(p):
            raise RouteError(f"{name}: {end.id} is not in the map: nobody has seen what is there")
        if p > self.known.grid.occupied_above:
            things = [t for t in self.known.things.values() if t.belief.get("Floor", 0.0) < 0.5]
            near = min(things, key=lambda t: math.dist(t.xy, end.xy), default=None)
            hint = f", near {near.id}" if near and math.dist(near.xy, end.xy) < 1.0 else ""
            raise RouteError(f"{name}: {end.id} is in an obstacle{hint}")


def walls_of(known: RouteMap) -> Mask:
    """(rows, cols): occupied cells that no thing of the map accounts for; one doesn't see past."""
    import cv2

    grid = known.grid.grid
    things = np.zeros(grid.probability.shape, dtype=np.uint8)
    for thing in known.things.values():
        corners = (thing.polygon_xy - grid.origin_xy) / grid.resolution_m - 0.5
        cv2.fillPoly(things, [np.round(corners).astype(np.int32)], 1)
    n = math.ceil(EDGE_M / grid.resolution_m)
    things = cv2.dilate(things, np.ones((2 * n + 1, 2 * n + 1), np.uint8)).astype(np.uint8)
    occupied = np.nan_to_num(grid.probability, nan=0.0) > known.grid.occupied_above
    walls: Mask = occupied & (things == 0)
    return walls


def _before(
    polygon_xy: Array, where: Drivable, walls: Mask, costs: NDArray[np.float64]
) -> Cell | None:
    """The cell nearest to a thing's outline (N, 2), m, that can be driven to and sees it, or None.

    `costs` (rows, cols): of driving there, inf where there is no way.
    """
    reach = math.ceil(REACH_M / where.resolution_m)
    cells = np.floor((polygon_xy - where.origin_xy) / where.resolution_m).astype(int)[:, ::-1]
    low = np.maximum(cells.min(axis=0) - reach - 1, 0)
    high = np.minimum(cells.max(axis=0) + reach + 2, where.free.shape)
    if (high <= low).any():
        return None
    part = np.s_[low[0] : high[0], low[1] : high[1]]
    distance, nearest = ndimage.distance_transform_edt(
        ~_drawn(polygon_xy, where, low, high), return_indices=True
    )
    found = np.isfinite(costs[part]) & where.free[part] & (distance <= reach)
    candidates = np.argwhere(found)
    order = np.lexsort((costs[part][found], distance[found]))
    for row, col in candidates[order]:
        if _sees(walls[part], (row, col), nearest[:, row, col]):
            return int(row + low[0]), int(col + low[1])
    return None


def _drawn(
    polygon_xy: Array, where: Drivable, low: NDArray[np.intp], high: NDArray[np.intp]
) -> Mask:
    """The outline's cells in a window; its nearest corner to it where it lies outside."""
    import cv2

    mask = np.zeros(tuple(high - low), dtype=np.uint8)
    corners = (polygon_xy - where.origin_xy) / where.resolution_m - low[::-1] - 0.5
    inside = np.clip(np.round(corners), 0, np.array(mask.shape[::-1]) - 1).astype(np.int32)
    cv2.fillPoly(mask, [inside], 1)
    drawn: Mask = mask > 0
    return drawn


def _sees(walls: Mask, start: tuple[int, int], end: NDArray[np.intp]) -> bool:
    """Whether no wall stands on the straight line between two cells."""
    n = int(max(abs(end[0] - start[0]), abs(end[1] - start[1]))) * 2 + 1
    line = np.round(np.linspace(start, end, n)).astype(int)
    return not walls[line[:, 0], line[:, 1]].any()
