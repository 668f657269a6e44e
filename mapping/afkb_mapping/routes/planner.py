"""Plans routes on a stored map, to a point, a node, a room or a thing."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.errors import RouteError
from afkb_mapping.routes.drivable import Cell, Drivable, Mask, drivable
from afkb_mapping.routes.ends import End, Kind, name_of
from afkb_mapping.routes.grid_paths import GridPaths
from afkb_mapping.routes.narrow_places import no_way
from afkb_mapping.routes.passed_nodes import passed
from afkb_mapping.routes.route_map import RouteMap, Spot
from afkb_mapping.routes.standing_points import Standing
from afkb_mapping.routes.straight import cost_of, length_of

Array = NDArray[np.float64]

ROUNDED = 1 / 128
"""The grid's image holds probabilities in steps of 1/255, rounded up."""


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """A way: its corners (N, 2), m, map frame, its length, m, and what of the map it passes.

    - `nodes`: its start, the robot places it passes, and its end, as far as these are nodes.
    - `through`: expected things whose place it crosses, as there is no other way.
    """

    path: Array
    length: float
    nodes: tuple[str, ...]
    doorways: tuple[str, ...]
    rooms: tuple[str, ...]
    through: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Planner:
    """Ways for one robot on one map; `expected` are the things it may drive over, at a cost."""

    known: RouteMap
    where: Drivable
    paths: GridPaths
    standing: Standing
    expected: tuple[str, ...] = ()

    @classmethod
    def of(cls, known: RouteMap, radius_m: float, over_expected: bool = False) -> Planner:
        """For a round robot of that radius, m, which goes round what is expected, or else not."""
        expected = [t.id for t in known.things.values() if not t.seen and over_expected]
        where = drivable(known.grid, radius_m, _only_expected(known, expected))
        paths = GridPaths(where)
        return cls(known, where, paths, Standing.of(known, where), tuple(expected))

    def route(self, start: End, goal: End) -> Route:
        """The shortest way; raises `RouteError` where there is none, and says why."""
        if isinstance(goal, Kind):
            raise RouteError(f"{goal.category}: any of a kind is searched for, by `search`")
        first = self.standing.start(start, "--from")
        self.standing.check(goal, "--to")
        last = self.goal(first, goal)
        path = self.paths.path(first, last) if last is not None else None
        if path is None:
            raise RouteError(no_way(self.standing, first, goal))
        return self.along(self._to_the_point(path, start, goal), start, goal)

    def route_round(self, start: End, goal: End) -> Route:
        """The shortest way round what is expected; where there is none, the one over it.

        Raises `RouteError` where there is neither.
        """
        try:
            return self.route(start, goal)
        except RouteError as error:
            if all(thing.seen for thing in self.known.things.values()):
                raise
            bold = Planner.of(self.known, self.where.radius_m, over_expected=True)
            try:
                return bold.route(start, goal)
            except RouteError:
                raise error from None

    def goal(self, start: Cell, goal: End) -> Cell | None:
        """The cell at which a way from a cell to an end ends, or None where none leads there."""
        return self.standing.at(goal, self.paths.costs(start))

    def along(self, path: Array, *ends: End) -> Route:
        """A path as a route, with what it passes; its ends are nodes of it where they are any."""
        told = passed(path, self.known, self.where, self.paths)
        first, *others = [name_of(end) for end in ends]
        nodes = [first, *(p for p in told.places if p not in (first, *others)), *others]
        nodes = [n for n in nodes if n in self.known.ids]
        through = _crossed(path, self.known, self.expected)
        return Route(path, length_of(path), tuple(nodes), told.doorways, told.rooms, through)

    def _to_the_point(self, path: Array, start: End, goal: End) -> Array:
        """The path from and to the very points that were named, where these are free."""
        path = path.copy() if len(path) > 1 else np.repeat(path, 2, axis=0)
        for end, at, beside in ((start, 0, 1), (goal, -1, -2)):
            if isinstance(end, Spot) and math.isfinite(cost_of(self.where, end.xy, path[beside])):
                path[at] = end.xy
        return path


def _only_expected(known: RouteMap, expected: list[str]) -> Mask:
    """(rows, cols): cells of which nothing is known but that one of these things may be there.

    Such a cell is as occupied as the thing is likely: what has been seen there was as good as free.
    """
    import cv2

    grid = known.grid.grid
    found = np.zeros(grid.probability.shape, dtype=np.bool_)
    for thing in (known.things[i] for i in expected):
        drawn = np.zeros(found.shape, np.uint8)
        corners = (thing.polygon_xy - grid.origin_xy) / grid.resolution_m - 0.5
        cv2.fillPoly(drawn, [np.round(corners).astype(np.int32)], 1)
        said = thing.existence * thing.matching_weight
        found |= (drawn > 0) & (np.abs(grid.probability - said) <= ROUNDED)
    return found


def _crossed(path: Array, known: RouteMap, expected: tuple[str, ...]) -> tuple[str, ...]:
    """Which of these things' outlines a path crosses."""
    from shapely import LineString, MultiPoint

    line = LineString(path)
    outlines = {i: MultiPoint(known.things[i].polygon_xy).convex_hull for i in expected}
    return tuple(i for i, outline in outlines.items() if line.intersects(outline))
