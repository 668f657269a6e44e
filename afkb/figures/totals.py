"""Sums of a source's counts over its buildings, ready to be asked for figures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from afkb.figures.counts import ANY_ROOM, Building, Counts, Pair, Source


@dataclass(slots=True)
class Totals:
    """One source's counts, summed over buildings.

    `rooms`, `buildings_with`: by room category. `holding`, `things`: rooms that hold it, and
    things, by (room category, category). `holding_anywhere`, `buildings_holding`: by category.
    `pairs`: rooms that hold both, by pair in name order; `paired`: the categories in them, for of
    any other the source doesn't tell what it stands with.
    """

    source: Source
    rooms: Counter[str] = field(default_factory=Counter)
    buildings_with: Counter[str] = field(default_factory=Counter)
    holding: Counter[Pair] = field(default_factory=Counter)
    things: Counter[Pair] = field(default_factory=Counter)
    holding_anywhere: Counter[str] = field(default_factory=Counter)
    named_holding: Counter[str] = field(default_factory=Counter)
    named_things: Counter[str] = field(default_factory=Counter)
    buildings_holding: Counter[str] = field(default_factory=Counter)
    pairs: Counter[Pair] = field(default_factory=Counter)
    paired: set[str] = field(default_factory=set)

    @property
    def named_rooms(self) -> int:
        """Rooms whose category the source tells."""
        return self.rooms.total() - self.rooms[ANY_ROOM]

    def add(self, building: Building, told: bool) -> None:
        """Count a building in; `told` if the source tells its buildings apart."""
        for room, tally in building.rooms.items():
            self.rooms[room] += tally.rooms
            self.holding_anywhere.update(tally.holding)
            if room == ANY_ROOM:
                continue
            self.named_holding.update(tally.holding)
            self.named_things.update(tally.things)
            self.holding.update({(room, c): n for c, n in tally.holding.items()})
            self.things.update({(room, c): n for c, n in tally.things.items()})
        self.pairs.update(building.pairs)
        self.paired.update(category for pair in building.pairs for category in pair)
        if told:
            self.buildings_with.update(dict.fromkeys(building.rooms, 1))
            held = {c for tally in building.rooms.values() for c in tally.holding}
            self.buildings_holding.update(dict.fromkeys(held, 1))


def totals_of(counts: Counts) -> Mapping[str, Totals]:
    """The sums of every source that counted rooms."""
    totals: dict[str, Totals] = {}
    for (source, name), building in counts.buildings.items():
        totals.setdefault(source, Totals(counts.sources[source])).add(building, told=bool(name))
    return totals
