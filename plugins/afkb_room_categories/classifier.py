"""P(purpose of a room | what it affords, and what was recognised in it).

The map's own belief is from affordances alone, independent of the exact things (paper §II.F). Here
a thing that is recognised speaks by its category in place of the class that it is counted for.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from afkb.flow import Entity, NodeKind, Room, TopologicalMap
from afkb.inference import Network, network_of
from afkb.knowledge import SOMETHING_ELSE, AfNet

RECOGNISED_FROM = 0.5
"""A thing is recognised where its category is likelier than all others together."""
NO_THINGS = (SOMETHING_ELSE, "Floor", "Ceiling", "Wall")


class CategoryClassifier:
    """Tells what rooms are for by counts of evidence classes and of recognised categories."""

    name = "with-categories"

    def __init__(self, knowledge_base: AfNet) -> None:
        self._knowledge_base = knowledge_base

    def beliefs(self, topological_map: TopologicalMap) -> Mapping[str, Mapping[str, float]]:
        """Room id to posterior, of every room."""
        network = network_of(self._knowledge_base)
        things = [e for e in topological_map.entities if e.kind is NodeKind.OBSERVED]
        return {
            room.id: posterior(network, room, [e for e in things if e.room == room.id])
            for room in topological_map.rooms
        }


def posterior(network: Network, room: Room, things: list[Entity]) -> dict[str, float]:
    """P(room category | the room's counts, the categories of its things), summing to 1.

    A class that recognised things alone were counted for is left unobserved: that they are there is
    said once.
    """
    counts, categories = Counter(room.evidence), Counter[str]()
    for thing in things:
        name = recognised(thing)
        if name is None or thing.existence < RECOGNISED_FROM:
            continue
        categories[name] += 1
        for evidence in _counted_for(network, thing):
            counts[evidence] -= 1
            if counts[evidence] <= 0:
                del counts[evidence]
    return network.room_posterior(counts, categories)


def recognised(thing: Entity) -> str | None:
    """The category that a thing is recognised as, or None."""
    belief = thing.category_belief
    best = max(belief, key=lambda name: belief[name], default=SOMETHING_ELSE)
    return best if best not in NO_THINGS and belief[best] >= RECOGNISED_FROM else None


def _counted_for(network: Network, thing: Entity) -> tuple[str, ...]:
    known = network.known(thing.affordances)
    return network.evidence_of(known, thing.size_xyz, thing.top_m)
