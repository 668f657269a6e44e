"""Where a thing of some kind may be: what was seen and may be one, and rooms that may hold one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.errors import KnowledgeError
from afkb_mapping.routes.route_map import MappedRoom, RouteMap, Thing

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

WORTH_A_LOOK = 0.01
"""What is less likely there is not looked for there: a hundred looks in vain for one find."""
SHARES_SEEN = ("ShareSeenLittle", "ShareSeenHalf", "ShareSeenMost")
"""Parameters of the ontology: what share of a room's things a visit finds, all equally likely."""


@dataclass(frozen=True, slots=True)
class Chance:
    """A node at which, with a probability, such a thing is, and why."""

    node: Thing | MappedRoom
    probability: float
    reason: str


def chances(category: str, known: RouteMap, kb: AfNet) -> list[Chance]:
    """All that make it worth a look, the likeliest first.

    Independent of each other: what a seen thing is says nothing of what was overlooked elsewhere.
    """
    kinds = {name for name in kb.categories if category in kb.kinds_of(name)}
    found = [*_things(known.things.values(), kinds, category), *_rooms(category, known, kb)]
    found = [chance for chance in found if chance.probability >= WORTH_A_LOOK]
    return sorted(found, key=lambda c: (-c.probability, c.node.id))


def _things(things: Iterable[Thing], kinds: set[str], category: str) -> Iterator[Chance]:
    for thing in things:
        share = sum(thing.belief.get(kind, 0.0) for kind in kinds)
        how = "seen" if thing.seen else "expected"
        reason = f"{thing.id}, {how}, is a {category} with {share:.2f}"
        yield Chance(thing, thing.existence * share, reason)


def _rooms(category: str, known: RouteMap, kb: AfNet) -> Iterator[Chance]:
    """Room posterior times how often such rooms hold one, less what was found if one were there."""
    holds = _held(category, kb)
    found = sum(kb.parameters[name] for name in SHARES_SEEN) / len(SHARES_SEEN)
    for room in known.rooms.values():
        p = sum(belief * holds.get(name, 0.0) for name, belief in room.belief.items())
        likeliest = next(iter(room.belief), "room")
        overlooked = 1.0 - found if room.visited else 1.0
        how = "overlooked in" if room.visited else "in"
        reason = f"{how} {room.id}, {likeliest} {room.belief.get(likeliest, 0.0):.2f}"
        yield Chance(room, p * overlooked, f"{reason}: such rooms hold one with {p:.2f}")


def _held(category: str, kb: AfNet) -> Mapping[str, float]:
    """P(a room of a category holds such a thing), by room category; empty where none counted it."""
    try:
        anywhere = kb.figures.base_rate(category)
    except KnowledgeError:
        return {}
    counted = set(kb.figures.rooms())
    return {
        room: kb.figures.object_in_room(category, room).p if room in counted else anywhere
        for room in kb.rooms
    }
