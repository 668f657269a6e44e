"""Room categories refitted from homes of one's own: how many a home has, and what they hold.

As `afkb.figures.refitting` does for single categories of things: what the ontology states is where
one's own figures begin, and counts for as much as so many homes or rooms.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from afkb.figures import Figures
from afkb.figures.smoothing import ROOM_WEIGHT, gamma_mean
from afkb.knowledge.model import Category, EvidenceClass, Feature, RoomCategory
from afkb.ontology.names import UNKNOWN_ROOM

AFFORDED_FROM = 0.5
"""A category counts for a class whose feature more than half of its things afford."""


def refitted_rooms(
    rooms: Mapping[str, RoomCategory], homes: Figures, counted_for: Mapping[str, tuple[str, ...]]
) -> Mapping[str, RoomCategory]:
    """The room categories with numbers and expected counts refitted to these homes.

    `counted_for`: category to the evidence classes that such a thing counts for. A class of which
    a room category states no count stays without; the unknown room stays as it is.
    """
    tallies = [building.rooms for building in homes.counts.buildings.values()]
    found = Counter[str]()
    things: dict[str, Counter[str]] = {name: Counter() for name in rooms}
    for home in tallies:
        for room, tally in home.items():
            found[room] += tally.rooms
            for category, number in tally.things.items():
                for evidence in counted_for.get(category, ()):
                    things[room][evidence] += number
    refitted = {
        name: room
        if name == UNKNOWN_ROOM
        else replace(
            room,
            expected_number=gamma_mean(
                found[name], len(tallies), room.expected_number, ROOM_WEIGHT
            ),
            expected_counts=MappingProxyType(
                {
                    evidence: gamma_mean(things[name][evidence], found[name], mean, ROOM_WEIGHT)
                    for evidence, mean in room.expected_counts.items()
                }
            ),
        )
        for name, room in rooms.items()
    }
    return MappingProxyType(refitted)


def classes_of(
    category: Category,
    classes: Mapping[str, EvidenceClass],
    features: Mapping[str, Feature],
) -> tuple[str, ...]:
    """The evidence classes that a typical thing of a category counts for, by name.

    Once for each feature, for the class that asks for the largest surface, and by its narrowest
    features that are counted; typical is the middle of each range. What is put on things has no
    height of its own, so that classes with a height don't count it.
    """
    size = (_middle(category.length_m), _middle(category.width_m), _middle(category.height_m))
    best: dict[str, EvidenceClass] = {}
    for evidence in classes.values():
        if category.afbits.get(evidence.feature, 0.0) < AFFORDED_FROM:
            continue
        bounded = any(map(math.isfinite, evidence.top_height_m))
        if category.top_height_m is None and bounded:
            continue
        if evidence.holds(size, _middle(category.top_height_m or (0.0, 0.0))):
            other = best.setdefault(evidence.feature, evidence)
            if evidence.least_area_m2 > other.least_area_m2:
                best[evidence.feature] = evidence
    implied = {b for feature in best for b in _broader(feature, features)}
    return tuple(sorted(e.name for feature, e in best.items() if feature not in implied))


def _middle(ends: tuple[float, float]) -> float:
    return (ends[0] + ends[1]) / 2


def _broader(feature: str, features: Mapping[str, Feature]) -> list[str]:
    found: list[str] = []
    while (above := features[feature].broader) and above not in found:
        found.append(above)
        feature = above
    return found
