"""Reads the tables of simulated homes: sums over all of them, with no building told."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

from afkb.csv_rows import read_rows
from afkb.figures.counting import THINGS, UNNAMED, Unknown
from afkb.figures.counts import ANY_ROOM, Building, Counts, RoomTally, Source
from afkb.figures.names import Names

HOUSEHOLD_ROOMS = 300
"""The rooms over which the table of pairs was made (its header says so: lift_N=300)."""
BDDL, BDDL_PAIRS, PROCTHOR, VIRTUALHOME = "bddl", "bddl_household", "procthor", "virtualhome"


def read_simulated(folder: Path, names: Names) -> tuple[Counts, Unknown]:
    """Counts of the public tables of simulated homes in a folder, each a source of its own.

    Where several of a table's names are one category of ours, the rooms that hold it are at least
    as many as hold the commonest name; that number is taken, which may be too low.
    """
    tables = _Tables(folder, names)
    counts = tables.bddl_rooms().plus(tables.bddl_pairs())
    return counts.plus(tables.procthor()).plus(tables.virtualhome()), tables.unknown


class _Tables:
    def __init__(self, folder: Path, names: Names) -> None:
        self.folder, self.names, self.unknown = folder, names, Unknown()

    def bddl_rooms(self) -> Counts:
        path = self.folder / "bddl_room_category_counts.csv"
        columns = ("room_type", "n_rooms", "category", "rooms_with_category", "total_instances")
        by_type: dict[str, tuple[int, dict[str, int], Counter[str]]] = {}
        left_out: Counter[str] = Counter()
        for row in read_rows(path, columns):
            kind = row["room_type"]
            if kind not in by_type:
                by_type[kind] = (row.whole("n_rooms"), {}, Counter())
            name = self._category(BDDL, row["category"])
            things = row.whole("total_instances")
            if name is None:
                left_out[THINGS] += things
                continue
            _, holding, total = by_type[kind]
            holding[name] = max(holding.get(name, 0), row.whole("rooms_with_category"))
            total[name] += things
        building = Building()
        for kind, (rooms, holding, total) in sorted(by_type.items()):
            room = self.names.rooms.find(BDDL, kind)
            if room is None:
                left_out[UNNAMED] += rooms
                self.unknown.rooms[BDDL][kind] += rooms
            else:
                building = building.plus(Building({room: RoomTally(rooms, holding, total)}))
        known = frozenset(c for _, holding, _ in by_type.values() for c in holding)
        return _block(BDDL, "simulated room", known, left_out, building)

    def bddl_pairs(self) -> Counts:
        path = self.folder / "bddl_cooccurrence_household.csv"
        holding: dict[str, int] = {}
        pairs: dict[tuple[str, str], int] = {}
        for row in read_rows(path, ("a", "b", "rooms_with_both", "rooms_a", "rooms_b")):
            a, b = (self._category(BDDL_PAIRS, row[c], BDDL) for c in ("a", "b"))
            for name, column in ((a, "rooms_a"), (b, "rooms_b")):
                if name is not None:
                    holding[name] = max(holding.get(name, 0), row.whole(column))
            if a is not None and b is not None and a != b:
                pair = (min(a, b), max(a, b))
                pairs[pair] = max(pairs.get(pair, 0), row.whole("rooms_with_both"))
        building = Building({ANY_ROOM: RoomTally(HOUSEHOLD_ROOMS, holding)}, pairs)
        return _block(BDDL_PAIRS, "simulated room", frozenset(holding), Counter(), building)

    def procthor(self) -> Counts:
        path = self.folder / "procthor_receptacle_given.csv"
        rows = read_rows(path, ("receptacle", "object", "count"))
        placed = ((row["object"], row["receptacle"], row.whole("count")) for row in rows)
        return self._supports(PROCTHOR, "thing on a receptacle", placed)

    def virtualhome(self) -> Counts:
        path = self.folder / "virtualhome_placing.csv"
        rows = read_rows(path, ("object", "relation", "destination"))
        placed = (
            (row["object"], row["destination"], 1) for row in rows if row["relation"] != "NEARBY"
        )
        return self._supports(VIRTUALHOME, "place where a thing may be put", placed)

    def _supports(self, source: str, unit: str, placed: Iterator[tuple[str, str, int]]) -> Counts:
        found: defaultdict[tuple[str, str], Counter[str]] = defaultdict(Counter)
        left_out: Counter[str] = Counter()
        for thing, support, count in placed:
            ours, on = self._category(source, thing), self._category(source, support)
            if ours is None or on is None:
                left_out[THINGS] += count
            else:
                found[source, ours][on] += count
        known = frozenset(thing for _, thing in found)
        described = Source(source, False, unit, 1.0, known, dict(left_out))
        return Counts({source: described}, {}, {key: dict(on) for key, on in found.items()})

    def _category(self, source: str, called: str, table: str = "") -> str | None:
        name = self.names.categories.find(table or source, called)
        if name is None:
            self.unknown.things[source][called] += 1
        return name


def _block(
    name: str, unit: str, known: frozenset[str], left_out: Counter[str], building: Building
) -> Counts:
    source = Source(name, False, unit, 1.0, known, dict(left_out))
    return Counts({name: source}, {(name, ""): building})
