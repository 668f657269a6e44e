"""A search for any thing of a kind: places to look in, their order, and the way along them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csgraph

from afkb.errors import RouteError
from afkb_mapping.routes.drivable import Cell
from afkb_mapping.routes.ends import End, Kind
from afkb_mapping.routes.planner import Planner, Route
from afkb_mapping.routes.search_order import (
    SearchOrder,
    best_order,
    expected_way,
    naive_orders,
    way_if_known,
)
from afkb_mapping.routes.search_places import Chance, chances
from afkb_mapping.routes.straight import length_of

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

Array = NDArray[np.float64]

MOST_PLACES = 20
"""Places that are looked in at most, the likeliest: the rest adds little to what is found."""
SAME_PLACE_M = 1.0
"""Who stands this near to another place looks in both at once."""


@dataclass(frozen=True, slots=True, eq=False)
class SearchPlace:
    """Where the robot stands to look, what may be there, and how likely one of it is."""

    cell: Cell
    xy: Array
    room: str | None
    found: tuple[Chance, ...]

    @property
    def probability(self) -> float:
        """That at least one of its chances is a hit; they are independent."""
        return 1.0 - math.prod(1.0 - c.probability for c in self.found)


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """A search: its route, its places in order, metres to each, and what it is expected to cost.

    - `order.expected_m`: until found, or until all places were looked in. `known_m`: of one who
      knows where it is. `nearest_m`, `probable_m`: of going to the nearest next, and to the
      likeliest next.
    - `nowhere`: probability that none of the places holds one.
    """

    route: Route
    places: tuple[SearchPlace, ...]
    metres: tuple[float, ...]
    order: SearchOrder
    known_m: float
    nearest_m: float
    probable_m: float
    nowhere: float


def search(planner: Planner, kb: AfNet, start: End, kind: Kind) -> Search:
    """The order of places with the least expected way; raises `RouteError` where there is none."""
    first = planner.standing.start(start, "--from")
    places = _places(planner, first, chances(kind.category, planner.known, kb), kind)
    cells = [first, *(p.cell for p in places)]
    legs = {(j, i): _leg(planner, a, b) for (j, a), (i, b) in combinations(enumerate(cells), 2)}
    ways = np.zeros((len(cells), len(cells)))
    for (j, i), leg in legs.items():
        ways[i, j] = ways[j, i] = max(length_of(leg), 1e-6)
    ways = csgraph.shortest_path(ways, method="FW")
    p = np.array([place.probability for place in places])
    order = best_order(p, ways)
    stops = [0, *(i + 1 for i in order.order)]
    path = [legs[a, b] if a < b else legs[b, a][::-1] for a, b in pairwise(stops)]
    whole = np.concatenate([path[0], *(leg[1:] for leg in path[1:])])
    nearest, probable = (expected_way(o, p, ways) for o in naive_orders(p, ways))
    ordered = tuple(places[i] for i in order.order)
    return Search(
        planner.along(whole, start, *(place.found[0].node for place in ordered)),
        ordered,
        tuple(float(m) for m in np.cumsum([length_of(leg) for leg in path])),
        order,
        way_if_known(p, ways),
        nearest,
        probable,
        float(np.prod(1.0 - p)),
    )


def _leg(planner: Planner, start: Cell, end: Cell) -> Array:
    """The path between two cells; all of them are reached from the first one."""
    path = planner.paths.path(start, end)
    assert path is not None
    return path


def _places(planner: Planner, start: Cell, found: list[Chance], kind: Kind) -> list[SearchPlace]:
    """Where to stand for each chance; chances that one place serves are one."""
    if not found:
        raise RouteError(
            f"{kind.category}: nothing in this map is likely one, and no room to hold one"
        )
    costs = planner.paths.costs(start)
    places: list[SearchPlace] = []
    for chance in found:
        cell = planner.standing.at(chance.node, costs)
        if cell is None:
            continue
        xy = planner.where.middles(np.array([cell]))[0]
        room = getattr(chance.node, "room", None) or chance.node.id
        at = next((i for i, p in enumerate(places) if _serves(p, xy, room)), None)
        if at is None:
            places.append(SearchPlace(cell, xy, room, (chance,)))
        else:
            p = places[at]
            places[at] = SearchPlace(p.cell, p.xy, p.room, (*p.found, chance))
    if not places:
        raise RouteError(
            f"{kind.category}: no way to {', '.join(c.node.id for c in found[:3])}, where one may "
            f"be, for a robot of radius {planner.where.radius_m:.2f} m; take a smaller one"
        )
    places.sort(key=lambda p: (-p.probability, p.found[0].node.id))
    return places[:MOST_PLACES]


def _serves(place: SearchPlace, xy: Array, room: str) -> bool:
    return place.room == room and float(np.linalg.norm(place.xy - xy)) <= SAME_PLACE_M
