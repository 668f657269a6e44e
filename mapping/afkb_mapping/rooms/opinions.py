"""What room classifiers make of a map's rooms, beside what the mapper does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from afkb.flow import TopologicalMap
from afkb.plugins.protocols import RoomClassifier
from afkb_mapping.perception import blamed


def with_opinions(found: TopologicalMap, classifiers: Sequence[RoomClassifier]) -> TopologicalMap:
    """The map with the beliefs of room classifiers, by their names, beside its own.

    Raises `PluginError` that names the classifier that fails.
    """
    told = {}
    for classifier in classifiers:
        with blamed("room classifier", classifier.name):
            told[classifier.name] = classifier.beliefs(found)
    rooms = (
        replace(room, other_beliefs={n: b[room.id] for n, b in told.items() if room.id in b})
        for room in found.rooms
    )
    return replace(found, rooms=tuple(rooms))
