"""Counts as CSV files: compact, in a fixed order, the same bytes for the same counts."""

from __future__ import annotations

import os
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from afkb.csv_rows import Row, csv_text, read_rows
from afkb.errors import KnowledgeError
from afkb.figures.counts import Building, Counts, Pair, RoomTally, Source
from afkb.figures.totals import Totals, totals_of

MANY_BUILDINGS = 20
"""A source of fewer buildings keeps all its pairs; for more, these two keep the files small."""
PAIR_BUILDINGS = 5
"""A pair is kept if so many buildings of its source hold it."""
EVERYWHERE = 0.5
"""What a larger share of a source's rooms hold is in no pair: it tells nothing of the rest."""
SOURCES = ("source", "kind", "unit", "weight", "left_out", "categories")
ROOMS = ("source", "number", "building", "room", "rooms", "objects")
PAIRS = ("source", "category", "other", "buildings")
SUPPORTS = ("source", "thing", "supports")
REAL, SYNTHETIC = "real", "synthetic"


def write_counts(counts: Counts, folder: Path) -> None:
    """Write the counts into a folder: `sources`, `rooms`, `pairs` and `supports`, all or none."""
    numbers = _numbers(counts)
    tables: dict[str, tuple[Sequence[str], Iterable[Sequence[object]]]] = {
        "sources": (SOURCES, _source_rows(counts)),
        "rooms": (ROOMS, _room_rows(counts, numbers)),
        "pairs": (PAIRS, _pair_rows(counts, numbers)),
        "supports": (SUPPORTS, _support_rows(counts)),
    }
    texts = {name: csv_text(header, rows) for name, (header, rows) in tables.items()}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / f".{name}.csv.new").write_text(text, encoding="utf-8", newline="")
        for name in texts:
            os.replace(folder / f".{name}.csv.new", folder / f"{name}.csv")  # noqa: PTH105
    except OSError as error:
        what = error.strerror or str(error)
        raise KnowledgeError(f"{folder}: can't be written: {what}; choose --out") from error


def read_counts(folder: Path) -> Counts:
    """The counts in a folder; `KnowledgeError` with file and line for what can't be read."""
    sources = {s.name: s for s in map(_source, read_rows(folder / "sources.csv", SOURCES))}
    rooms: defaultdict[tuple[str, str], dict[str, RoomTally]] = defaultdict(dict)
    numbered: dict[tuple[str, str], str] = {}
    for row in read_rows(folder / "rooms.csv", ROOMS):
        key = (_known(row, sources), row["building"])
        numbered[row["source"], row["number"]] = row["building"]
        rooms[key][row["room"]] = _tally(row)
    pairs: defaultdict[tuple[str, str], dict[Pair, int]] = defaultdict(dict)
    for row in read_rows(folder / "pairs.csv", PAIRS):
        pair = (row["category"], row["other"])
        for number, both in _entries(row, "buildings").items():
            if (row["source"], number) not in numbered:
                raise row.error(f"no row of rooms.csv has number {number}; count again")
            pairs[row["source"], numbered[row["source"], number]][pair] = both
    supports = {
        (_known(row, sources), row["thing"]): _entries(row, "supports")
        for row in read_rows(folder / "supports.csv", SUPPORTS)
    }
    buildings = {key: Building(tallies, pairs.get(key, {})) for key, tallies in rooms.items()}
    return Counts(sources, buildings, supports)


def _numbers(counts: Counts) -> dict[tuple[str, str], int]:
    """Short names for buildings: their place among their source's."""
    order: Counter[str] = Counter()
    numbers = {}
    for source, building in sorted(counts.buildings):
        numbers[source, building] = order[source]
        order[source] += 1
    return numbers


def _source_rows(counts: Counts) -> Iterable[Sequence[object]]:
    for name, source in sorted(counts.sources.items()):
        kind = REAL if source.real else SYNTHETIC
        categories = "|".join(sorted(source.categories))
        yield name, kind, source.unit, source.weight, _joined(source.left_out), categories


def _room_rows(
    counts: Counts, numbers: Mapping[tuple[str, str], int]
) -> Iterable[Sequence[object]]:
    for key, building in sorted(counts.buildings.items()):
        for room, tally in sorted(building.rooms.items()):
            objects = "|".join(
                f"{name}:{rooms}:{tally.things[name]}"
                if name in tally.things
                else f"{name}:{rooms}"
                for name, rooms in sorted(tally.holding.items())
            )
            yield key[0], numbers[key], key[1], room, tally.rooms, objects


def _pair_rows(
    counts: Counts, numbers: Mapping[tuple[str, str], int]
) -> Iterable[Sequence[object]]:
    held: defaultdict[tuple[str, Pair], dict[str, int]] = defaultdict(dict)
    for key, building in sorted(counts.buildings.items()):
        for pair, both in building.pairs.items():
            held[key[0], pair][str(numbers[key])] = both
    many = {s for s, n in Counter(s for s, _ in numbers).items() if n >= MANY_BUILDINGS}
    common = {source: _everywhere(totals) for source, totals in totals_of(counts).items()}
    for (source, pair), by_building in sorted(held.items()):
        enough = len(by_building) >= PAIR_BUILDINGS and common[source].isdisjoint(pair)
        if enough or source not in many:
            yield source, *pair, _joined(by_building, key=int)


def _everywhere(totals: Totals) -> set[str]:
    most = EVERYWHERE * totals.rooms.total()
    return {c for c, rooms in totals.holding_anywhere.items() if rooms > most}


def _support_rows(counts: Counts) -> Iterable[Sequence[object]]:
    for (source, thing), supports in sorted(counts.supports.items()):
        yield source, thing, _joined(supports)


def _joined(numbers: Mapping[str, int], key: type[int] | None = None) -> str:
    """Names with their numbers, as in `a:2|b`; 1 goes without saying."""
    names = sorted(numbers, key=key)
    return "|".join(n if numbers[n] == 1 else f"{n}:{numbers[n]}" for n in names)


def _source(row: Row) -> Source:
    if row["kind"] not in (REAL, SYNTHETIC):
        raise row.error(f"kind {row['kind']!r} is neither {REAL} nor {SYNTHETIC}")
    try:
        weight = float(row["weight"])
    except ValueError:
        weight = 0.0
    if not 0 < weight <= 1:
        raise row.error(f"weight {row['weight']!r} is no number above 0 and up to 1")
    categories = frozenset(filter(None, row["categories"].split("|")))
    return Source(
        row["source"],
        row["kind"] == REAL,
        row["unit"],
        weight,
        categories,
        _entries(row, "left_out"),
    )


def _known(row: Row, sources: Mapping[str, Source]) -> str:
    if row["source"] not in sources:
        raise row.error(f"sources.csv has no source {row['source']!r}; count again")
    return row["source"]


def _tally(row: Row) -> RoomTally:
    rooms = row.whole("rooms")
    holding: dict[str, int] = {}
    things: dict[str, int] = {}
    for entry in filter(None, row["objects"].split("|")):
        name, _, numbers = entry.partition(":")
        held, _, number = numbers.partition(":")
        holding[name] = row.whole_number(held, f"rooms with {name}")
        if number:
            things[name] = row.whole_number(number, f"the number of {name}")
        if holding[name] > rooms or things.get(name, holding[name]) < holding[name]:
            raise row.error(f"{entry!r} can't be: {rooms} rooms, and a thing in each that has one")
    return RoomTally(rooms, holding, things)


def _entries(row: Row, column: str) -> dict[str, int]:
    entries: dict[str, int] = {}
    for entry in filter(None, row[column].split("|")):
        name, colon, number = entry.partition(":")
        entries[name] = row.whole_number(number, f"the count of {name}") if colon else 1
    return entries
