"""The paper's task: the robot is in the hall and is to bring a mug from the kitchen (§II.F)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import RouteError
from afkb.knowledge import AfNet
from afkb_mapping.routes.ends import Kind, end_of
from afkb_mapping.routes.planner import Planner
from afkb_mapping.routes.route_map import RouteMap, Thing
from afkb_mapping.routes.search import Search, SearchPlace, search
from afkb_paper.judged import Judged
from afkb_paper.passing import ROBOT_RADIUS_M

Array = NDArray[np.float64]

START, GOAL = "LivingRoom", "Mug"
FETCHED = frozenset({"Mug", "Cup"})
"""A cup will do: what tells the two apart is their material, which no depth camera sees."""
NEAR_M = 0.1
"""Outlines are known to a few cells."""


@dataclass(frozen=True, slots=True, eq=False)
class Fetched:
    """The way from the hall until a true mug or cup is looked at.

    - `places`: looked at until then, that one too; `length_m`: driven until then. None where
      none of the places holds one. `room`: where it is found, by its likeliest category.
    - `path` (N, 2): the route through all places, m, map frame.
    """

    places: int | None
    length_m: float | None
    room: str | None
    thing: str | None
    path: Array


def fetched(judged: Judged, folder: Path, kb: AfNet) -> Fetched | str:
    """The search as `afkb route MAP --from LivingRoom --to mug` plans it, or why there is none."""
    known = RouteMap.read(folder)
    try:
        planner = Planner.of(known, ROBOT_RADIUS_M)
        found = search(planner, kb, end_of(START, known, kb), Kind(GOAL))
    except RouteError as error:
        return str(error)
    for number, place in enumerate(found.places):
        if thing := _held(place, judged):
            room = _purpose(known, place.room)
            path = _until(found, number)
            return Fetched(number + 1, found.metres[number], room, thing, path)
    return Fetched(None, None, None, None, found.route.path)


def _purpose(known: RouteMap, id_: str | None) -> str | None:
    """What a room is most likely for; its id where nothing is believed of it."""
    belief = known.rooms[id_].belief if id_ is not None and id_ in known.rooms else {}
    return max(belief, key=lambda name: belief[name]) if belief else id_


def _held(place: SearchPlace, judged: Judged) -> str | None:
    """The true mug or cup that is within the outline of something looked at there, or None."""
    import shapely

    looked_at = [chance.node for chance in place.found if isinstance(chance.node, Thing)]
    around = [shapely.MultiPoint(n.polygon_xy).convex_hull.buffer(NEAR_M) for n in looked_at]
    for thing in judged.truth.things:
        at = shapely.Point(judged.xy(*thing.box.center_xyz[:2]))
        if thing.category in FETCHED and any(outline.contains(at) for outline in around):
            return thing.name
    return None


def _until(found: Search, number: int) -> Array:
    """The part of the route that leads to a place, (N, 2) m."""
    path, left = found.route.path, found.metres[number]
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    last = int(np.searchsorted(np.cumsum(steps), left - 1e-6)) + 1
    return np.vstack([path[:last], found.places[number].xy])
