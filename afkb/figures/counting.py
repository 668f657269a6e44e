"""Counts rooms and what is in them, under the ontology's own names."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path

from afkb.figures.counts import Building, Counts, RoomTally, Source
from afkb.figures.names import HOMES, Names
from afkb.figures.reading import LAYOUTS, SeenRoom, Shape, seen_rooms, shape_of

UNNAMED, TIED, EMPTY = "rooms of no known category", "rooms of tied categories", "rooms empty"
THINGS = "things of unknown name"
_SEVERAL = "Tie:"


@dataclass(slots=True)
class Unknown:
    """Names that nothing here has, with how often they were met, by source."""

    things: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    rooms: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))


def count_rooms(
    paths: Sequence[Path], names: Names, shape: Shape = Shape.AUTO
) -> tuple[Counts, Unknown]:
    """Counts of the rooms in these tables, and the names that weren't understood.

    Rooms of no known category and those whose category is a tie are left out, and counted as such.
    A thing counts once, under the category that its name stands for, not under a broader one.
    """
    by_shape: defaultdict[Shape, list[Path]] = defaultdict(list)
    for path in paths:
        by_shape[shape_of(path) if shape is Shape.AUTO else shape].append(path)
    counts, unknown = Counts(), Unknown()
    for found in sorted(by_shape):
        counts = counts.plus(_count(seen_rooms(by_shape[found], found), names, found, unknown))
    return counts, unknown


def _count(rooms: Iterable[SeenRoom], names: Names, shape: Shape, unknown: Unknown) -> Counts:
    layout, source = LAYOUTS[shape], str(shape)
    left_out: Counter[str] = Counter()
    counted: defaultdict[str, list[tuple[str, dict[str, int]]]] = defaultdict(list)
    for room in rooms:
        category = names.rooms.find(source, room.category)
        if category is None:
            left_out[TIED if room.category.startswith(_SEVERAL) else UNNAMED] += 1
            unknown.rooms[source][room.category] += 1
            continue
        if layout.empty_says_nothing and not room.things:
            left_out[EMPTY] += 1
            continue
        things = _ours(room, names, source, unknown, left_out)
        counted[room.building].append((category, things))
    buildings = {(source, name): _building(seen) for name, seen in sorted(counted.items())}
    known = names.categories.known(source)
    if shape == HOMES:
        known = frozenset(c for seen in counted.values() for _, things in seen for c in things)
    described = Source(source, True, layout.unit, layout.unit_weight, known, dict(left_out))
    return Counts({source: described}, buildings)


def _ours(
    room: SeenRoom, names: Names, source: str, unknown: Unknown, left_out: Counter[str]
) -> dict[str, int]:
    things: Counter[str] = Counter()
    for called, count in room.things.items():
        name = names.categories.find(source, called)
        if name is None:
            left_out[THINGS] += count
            unknown.things[source][called] += count
        else:
            things[name] += count
    return dict(things)


def _building(seen: Sequence[tuple[str, dict[str, int]]]) -> Building:
    building = Building()
    for category, things in seen:
        tally = RoomTally(1, dict.fromkeys(things, 1), things)
        pairs = dict.fromkeys(combinations(sorted(things), 2), 1)
        building = building.plus(Building({category: tally}, pairs))
    return building
