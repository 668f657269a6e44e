"""What stands in which room of a map, as a table that people correct."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from afkb.errors import MapError
from afkb.knowledge import SOMETHING_ELSE, AfNet
from afkb.store import StoredMap
from afkb.store.shapes import node_json, rooms_json

COLUMNS = ("building", "room", "category", "objects", "unsure")
"""Those of homes that `afkb ontology count` reads; `unsure` is for whoever corrects, unread."""
SURE_FROM = 0.5
"""A thing is named where its category is likelier than all others together."""
NO_THINGS = (SOMETHING_ELSE, "Floor", "Wall", "Ceiling")


@dataclass(frozen=True, slots=True)
class MappedRoom:
    """One room of a mapped home, under the ontology's names.

    `things`: category to how many; `unsure`: id, likeliest category and its probability.
    """

    building: str
    room: str
    category: str
    things: dict[str, int]
    unsure: tuple[tuple[str, str, float], ...]


def rooms_of(stored: StoredMap) -> Iterator[MappedRoom]:
    """The rooms of a map that the robot stood in; its folder's name is the building's.

    Raises `MapError` where it has none.
    """
    rooms = [room for room in rooms_json(stored) if room["visited"]]
    if not rooms:
        raise MapError(f"{stored.folder}: the robot stood in no room of it; map a home")
    building = stored.folder.resolve().name
    things = list(_things(stored))
    for room in rooms:
        here = [(id_, *best) for id_, at, best in things if at == room["id"]]
        named = Counter(name for _, name, p in here if p >= SURE_FROM)
        unsure = tuple(found for found in here if found[2] < SURE_FROM)
        belief = room["belief"]
        assert isinstance(belief, dict)
        yield MappedRoom(building, str(room["id"]), next(iter(belief)), dict(named), unsure)


def _things(stored: StoredMap) -> Iterator[tuple[str, str, tuple[str, float]]]:
    """Id, room and likeliest category of what was seen and stands by itself."""
    for node in stored.instances("ObservedEntity"):
        shape = node_json(stored, node, "ObservedEntity")
        category, existence = shape["category"], shape["existence"]
        assert isinstance(category, dict) and isinstance(existence, float)
        best = next(iter(category.items()), (SOMETHING_ELSE, 0.0))
        if best[0] not in NO_THINGS and existence >= SURE_FROM and "part_of" not in shape:
            yield str(shape["id"]), str(shape["room"]), best


def table_text(rooms: Iterable[MappedRoom], knowledge_base: AfNet) -> str:
    """The rooms as CSV, things and rooms by their labels.

    Raises `MapError` for two maps of one name, whose rooms nobody could tell apart.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    seen: set[tuple[str, str]] = set()
    for room in rooms:
        if (room.building, room.room) in seen:
            raise MapError(f"two maps are called {room.building!r}; rename the folder of one")
        seen.add((room.building, room.room))
        purpose = knowledge_base.rooms.get(room.category)
        named = ((_label(name, knowledge_base), n) for name, n in sorted(room.things.items()))
        unsure = (f"{id_} {_label(name, knowledge_base)} {p:.2f}" for id_, name, p in room.unsure)
        writer.writerow(
            (
                room.building,
                room.room,
                purpose.label if purpose else room.category,
                "|".join(f"{label}:{n}" for label, n in named),
                "|".join(unsure),
            )
        )
    return out.getvalue()


def _label(name: str, knowledge_base: AfNet) -> str:
    category = knowledge_base.categories.get(name)
    return category.label if category else name
