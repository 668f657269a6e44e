"""What room classifiers make of a map's rooms, beside what the mapper does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from afkb.errors import PluginError
from afkb.flow import TopologicalMap
from afkb.plugins.protocols import RoomClassifier
from afkb_mapping.perception import blamed


def with_opinions(found: TopologicalMap, classifiers: Sequence[RoomClassifier]) -> TopologicalMap:
    """The map with the beliefs of room classifiers, by their names, beside its own.

    One that fails is left out, and named in the map's notes: a whole run has gone before it.
    """
    told, notes = {}, list(found.notes)
    for classifier in classifiers:
        try:
            with blamed("room classifier", classifier.name):
                told[classifier.name] = classifier.beliefs(found)
        except PluginError as error:
            notes.append(str(error))
    rooms = (
        replace(room, other_beliefs={n: b[room.id] for n, b in told.items() if room.id in b})
        for room in found.rooms
    )
    return replace(found, rooms=tuple(rooms), notes=tuple(notes))
