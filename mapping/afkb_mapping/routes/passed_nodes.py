"""What of the graph a path passes: robot places, doorways and rooms, in their order."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.routes.drivable import Drivable
from afkb_mapping.routes.grid_paths import GridPaths
from afkb_mapping.routes.route_map import RouteMap, Spot
from afkb_mapping.routes.standing_points import SNAP_M

Array = NDArray[np.float64]

Item = TypeVar("Item")

STEP_M = 0.1
JAMB_M = 0.15
"""A doorway's gap is taken wider by so much on either side: jambs are known to a few cells."""


@dataclass(frozen=True, slots=True)
class Passed:
    """Ids in the order in which a path comes by them: robot places, doorways, rooms."""

    places: tuple[str, ...]
    doorways: tuple[str, ...]
    rooms: tuple[str, ...]


def passed(path: Array, known: RouteMap, where: Drivable, paths: GridPaths) -> Passed:
    """What a path (N, 2), m, passes.

    Of the places, at each point the one to which the way is shortest: its part of the free space.
    """
    spots = [
        (place, cell)
        for place in known.places.values()
        if (cell := where.nearest(place.xy, SNAP_M)) is not None
    ]
    nearest = paths.nearest_of([cell for _, cell in spots])
    cells = [where.cell(xy) for xy in _along(path)]
    numbers = [int(nearest[cell]) for cell in cells if cell is not None]
    places = [spots[n][0] for n in _without_repeats(numbers) if n >= 0]
    return Passed(
        tuple(p.id for p in places),
        tuple(_crossed(path, known.doorways.values())),
        tuple(_without_repeats(p.room for p in places if p.room is not None)),
    )


def _along(path: Array) -> Array:
    """Points of a path, `STEP_M` apart."""
    parts = [path[:1]]
    for a, b in pairwise(path):
        n = max(1, math.ceil(float(np.linalg.norm(b - a)) / STEP_M))
        parts.append(a + (np.arange(1, n + 1) / n)[:, None] * (b - a))
    return np.concatenate(parts)


def _crossed(path: Array, doorways: Iterable[Spot]) -> list[str]:
    """Ids of the doorways whose gap a path crosses, in their order along it."""
    from shapely import LineString, Point

    line, found = LineString(path), []
    for door in doorways:
        half = door.width / 2 + JAMB_M
        across = np.array([-math.sin(door.yaw), math.cos(door.yaw)]) * half
        if line.intersects(LineString([door.xy - across, door.xy + across])):
            found.append((line.project(Point(door.xy)), door.id))
    return [id_ for _, id_ in sorted(found)]


def _without_repeats(items: Iterable[Item]) -> list[Item]:
    """The items, those that follow on themselves once."""
    return [item for item, _ in groupby(items)]
