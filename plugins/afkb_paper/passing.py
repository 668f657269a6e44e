"""Ways from one side of a thing to the other, and which of them lead through it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb.store.stored_grid import StoredGrid
from afkb_mapping.routes.drivable import drivable
from afkb_mapping.routes.grid_paths import GridPaths
from afkb_mapping.routes.standing_points import SNAP_M

if TYPE_CHECKING:
    from shapely import Polygon

Array = NDArray[np.float64]

ROBOT_RADIUS_M = 0.2
"""As `afkb route` takes it."""
NEAR_M = 4.0
"""Ways past a thing begin and end where the robot stood within so far from it."""
APART_M = 0.5
"""Of points nearer to each other, one."""
TOUCHED_M = 0.1
"""Two cells of the grid: outlines are known no better, and who grazes one so does not hit it."""


@dataclass(frozen=True, slots=True, eq=False)
class Passing:
    """Ways past a thing: each as corners (N, 2), m, or None; and how much of each is within it, m.

    A way is within the thing where the robot's rim would touch it.
    """

    ways: Sequence[Array | None]
    within_m: Sequence[float]

    @property
    def hits(self) -> int:
        """How many ways lead through it."""
        return sum(metres > TOUCHED_M for metres in self.within_m)


def points_around(at: Polygon, stood_xy: Array) -> list[Array]:
    """Points (2,), m, near an outline at which the robot stood; `stood_xy`: (N, 2) of all views.

    There a robot can stand, whatever a map says.
    """
    import shapely

    found: list[Array] = []
    for xy in stood_xy:
        if all(np.hypot(*(xy - other)) >= APART_M for other in found):
            found.append(xy)
    return [xy for xy in found if at.distance(shapely.Point(xy)) <= NEAR_M]


def ways_between(
    points: Sequence[Array], grid: OccupancyGrid, stored: StoredGrid, at: Polygon
) -> Passing:
    """The shortest ways between all pairs of points, on another grid of the same place.

    Unknown cells may be driven over, as navigation stacks do by default: else a robot would never
    get to what it has not seen.
    """
    known = replace(grid, probability=np.nan_to_num(grid.probability, nan=0.0))
    where = drivable(replace(stored, grid=known), ROBOT_RADIUS_M)
    paths, touched = GridPaths(where), at.buffer(ROBOT_RADIUS_M)
    cells = [where.nearest(xy, SNAP_M) for xy in points]
    ways = [
        None if start is None or end is None else paths.path(start, end)
        for start, end in combinations(cells, 2)
    ]
    return Passing(ways, [_within(way, touched) for way in ways])


def _within(way: Array | None, touched: Polygon) -> float:
    """How much of a way lies within an outline, m; nothing of none."""
    import shapely

    if way is None or len(way) < 2:
        return 0.0
    return float(shapely.LineString(way).intersection(touched).length)
