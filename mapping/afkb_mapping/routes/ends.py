"""What a route's ends are called: a point, a node, a room by id or purpose, or a kind of thing."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from afkb.errors import RouteError
from afkb.finding.names import find_category, near_names, squeezed
from afkb_mapping.routes.route_map import MappedRoom, RouteMap, Spot, Thing

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
POINT = re.compile(rf"\s*\(?\s*({NUMBER})\s*,\s*({NUMBER})\s*\)?\s*")
LIKELY_ROOM = 0.2
"""A room that is less likely what it is called isn't meant."""


@dataclass(frozen=True, slots=True)
class Kind:
    """Any thing of an object category, wherever it may be."""

    category: str


End = Spot | Thing | MappedRoom | Kind


def end_of(text: str, known: RouteMap, kb: AfNet) -> End:
    """What a text names in a map; raises `RouteError`, with names that are near, for nothing.

    Tried in this order: `x,y` (m, map frame), the id of a node or room, the category of a room (the
    likeliest such room is meant), an object category. Case, spaces and hyphens make no difference.
    """
    if point := POINT.fullmatch(text):
        return Spot(text.replace(" ", ""), np.array([float(point[1]), float(point[2])]))
    ids: dict[str, End] = {**known.places, **known.doorways, **known.rooms, **known.things}
    named = {squeezed(id_): end for id_, end in ids.items()}
    if end := named.get(squeezed(text)):
        return end
    rooms = {squeezed(name): name for name in kb.rooms}
    if category := rooms.get(squeezed(text)):
        return _room(category, known)
    if category := find_category(text, kb):
        return Kind(category)
    raise RouteError(_unknown(text, [*ids, *kb.rooms, *kb.categories]))


def name_of(end: End) -> str:
    """The id of a node, room or point; the category of a kind."""
    return end.category if isinstance(end, Kind) else end.id


def _room(category: str, known: RouteMap) -> MappedRoom:
    best = max(known.rooms.values(), key=lambda r: r.belief.get(category, 0.0), default=None)
    if best is None:
        raise RouteError(f"{category}: the map has no rooms; name a node or x,y")
    p = best.belief.get(category, 0.0)
    if p >= LIKELY_ROOM:
        return best
    there = ", ".join(f"{r.id} {next(iter(r.belief), '?')}" for r in known.rooms.values())
    raise RouteError(
        f"{category}: no room of the map is likely one ({best.id} is with {p:.2f}); "
        f"there are {there}"
    )


def _unknown(text: str, names: list[str]) -> str:
    near = near_names(text, names)
    hint = f"did you mean {', '.join(near)}?" if near else "see `afkb info` and `afkb rooms`"
    return f"{text!r} is no x,y, no node or room of the map, and no category; {hint}"
