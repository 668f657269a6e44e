"""Where a search for a thing of some kind looks: the regions that `afkb find` ranks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.finding import regions
from afkb_mapping.routes.route_map import MappedRoom, RouteMap, Thing

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

WORTH_A_LOOK = 0.01
"""What is less likely there is not looked for there: a hundred looks in vain for one find."""


@dataclass(frozen=True, slots=True)
class Chance:
    """A node at which, with a probability, such a thing is, and why."""

    node: Thing | MappedRoom
    probability: float
    reason: str


def chances(category: str, known: RouteMap, kb: AfNet) -> list[Chance]:
    """All that make it worth a look, the likeliest first; independent of each other."""
    return [
        Chance(known.rooms.get(r.node) or known.things[r.node], r.probability, r.reason)
        for r in regions(category, known.surroundings, kb)
        if r.probability >= WORTH_A_LOOK
    ]
