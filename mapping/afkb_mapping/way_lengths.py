"""How far it is from place to place: the weights of the ways in the graph."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from afkb.flow import OccupancyGrid, RobotPlace
from afkb.store.stored_grid import StoredGrid
from afkb_mapping.routes.drivable import drivable
from afkb_mapping.routes.grid_paths import GridPaths
from afkb_mapping.routes.standing_points import SNAP_M
from afkb_mapping.routes.straight import length_of

LEAST_RADIUS_M = 0.15
"""Of the smallest robots that drive about homes: what they can't pass is no way."""
FREE_BELOW, OCCUPIED_ABOVE = 0.196, 0.65
"""Thresholds of the field (nav2's map_server), by which the map's grid is written."""
MOST_DETOUR = 3.0
"""A way round that is longer than so many times what the robot went isn't the one it took."""

Ways = Mapping[tuple[str, str], float]


def way_lengths(
    grid: OccupancyGrid, places: Sequence[RobotPlace], ways: Ways
) -> Iterator[tuple[str, str, float]]:
    """Each way, from id to id, with its length, m: over free floor, or else as the robot went.

    `ways`: the pairs of places between which the robot went, with how far it went at least, m.
    """
    where = drivable(StoredGrid(grid, FREE_BELOW, OCCUPIED_ABOVE), LEAST_RADIUS_M)
    paths = GridPaths(where, limit_m=MOST_DETOUR * max(ways.values(), default=0.0))
    cells = {p.id: where.nearest(np.array([p.x, p.y]), SNAP_M) for p in places}
    for (source, target), went in ways.items():
        start, end = cells[source], cells[target]
        path = paths.path(start, end) if start is not None and end is not None else None
        free = length_of(path) if path is not None else np.inf
        yield source, target, free if free <= MOST_DETOUR * went else went
