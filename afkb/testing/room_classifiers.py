"""The contract of a room classifier."""

from __future__ import annotations

import math

from afkb.flow import TopologicalMap
from afkb.knowledge import UNKNOWN_ROOM, AfNet
from afkb.plugins.protocols import RoomClassifier
from afkb.testing.require import (
    require,
    require_known,
    require_name,
    require_probability,
    same,
)


def check_room_classifier(
    classifier: RoomClassifier, topological_map: TopologicalMap, knowledge_base: AfNet
) -> None:
    """Raise unless the classifier keeps its contract on a map.

    Deterministic, of rooms that are in the map, and in the ontology's words; beliefs sum to 1.
    """
    name = require_name(classifier, f"room classifier {type(classifier).__name__}")
    who = f"room classifier {name!r}"
    is_one = isinstance(classifier, RoomClassifier)
    require(is_one, who, "is no RoomClassifier", "see afkb.plugins.protocols")
    found = classifier.beliefs(topological_map)
    require(same(found, classifier.beliefs(topological_map)), who, "changes", "keep no state")
    rooms = {room.id for room in topological_map.rooms}
    stray = sorted(set(found) - rooms)
    require(not stray, who, f"tells of {stray}", "name rooms of the map")
    for room, belief in found.items():
        at = f"{who}, {room}"
        for category, p in belief.items():
            require_probability(p, at, category)
        whole = math.isclose(sum(belief.values()), 1.0, abs_tol=1e-6) and UNKNOWN_ROOM in belief
        require(whole, at, f"sums to {sum(belief.values()):.4f}", "make it 1, UnknownRoom included")
        require_known([c for c in belief if c != UNKNOWN_ROOM], knowledge_base.rooms, at, "rooms")
