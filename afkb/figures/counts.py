"""What was counted: rooms, the things in them and what stands together, building by building."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

from afkb.errors import KnowledgeError

ANY_ROOM = ""
"""The room category of rooms whose source does not tell it: they count for pairs only."""
Pair = tuple[str, str]
Key = TypeVar("Key", str, Pair)


@dataclass(frozen=True, slots=True)
class Source:
    """Who counted what.

    `unit`: what one row of the source is. `weight`: how much of a room one unit is worth.
    `categories`: those of which the source has a name, seen or not; for any other category its
    rooms say nothing. `left_out`: what was not counted, by reason.
    """

    name: str
    real: bool
    unit: str
    weight: float
    categories: frozenset[str]
    left_out: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RoomTally:
    """Rooms of one category in one building: how many, with each category, and the things."""

    rooms: int = 0
    holding: Mapping[str, int] = field(default_factory=dict)
    things: Mapping[str, int] = field(default_factory=dict)

    def plus(self, other: RoomTally) -> RoomTally:
        """Both together."""
        return RoomTally(
            self.rooms + other.rooms,
            added(self.holding, other.holding),
            added(self.things, other.things),
        )


@dataclass(frozen=True, slots=True)
class Building:
    """One building's rooms by category, and the rooms that hold both of a pair (in name order).

    A source that tells no buildings is one block, whose building has no name.
    """

    rooms: Mapping[str, RoomTally] = field(default_factory=dict)
    pairs: Mapping[Pair, int] = field(default_factory=dict)

    def plus(self, other: Building) -> Building:
        """Both together."""
        names = {*self.rooms, *other.rooms}
        none = RoomTally()
        rooms = {n: self.rooms.get(n, none).plus(other.rooms.get(n, none)) for n in names}
        return Building(rooms, added(self.pairs, other.pairs))


@dataclass(frozen=True, slots=True)
class Counts:
    """All that was counted: buildings by (source, building); supports by (source, thing)."""

    sources: Mapping[str, Source] = field(default_factory=dict)
    buildings: Mapping[tuple[str, str], Building] = field(default_factory=dict)
    supports: Mapping[tuple[str, str], Mapping[str, int]] = field(default_factory=dict)

    def plus(self, other: Counts) -> Counts:
        """Both counted together."""
        sources = dict(self.sources)
        for name, source in other.sources.items():
            sources[name] = _together(sources[name], source) if name in sources else source
        buildings = dict(self.buildings)
        for key, building in other.buildings.items():
            buildings[key] = buildings.get(key, Building()).plus(building)
        supports = dict(self.supports)
        for key, things in other.supports.items():
            supports[key] = added(supports.get(key, {}), things)
        return Counts(sources, buildings, supports)

    def without(self, buildings: Collection[str]) -> Counts:
        """The counts that these buildings have no part in, to judge figures on them.

        Raises `KnowledgeError` for a building that isn't here.
        """
        left_out = set(buildings)
        unknown = left_out - {name for _, name in self.buildings if name}
        if unknown:
            raise KnowledgeError(
                f"no counts of building {min(unknown)!r}; name buildings of the counted rooms"
            )
        kept = {key: b for key, b in self.buildings.items() if key[1] not in left_out}
        return replace(self, buildings=kept)

    def of(self, sources: Collection[str]) -> Counts:
        """The counts of these sources alone; `KnowledgeError` for one that isn't here."""
        for name in sources:
            if name not in self.sources:
                raise KnowledgeError(f"no counts of {name!r}; there are: {', '.join(self.sources)}")
        return Counts(
            {n: s for n, s in self.sources.items() if n in sources},
            {key: b for key, b in self.buildings.items() if key[0] in sources},
            {key: s for key, s in self.supports.items() if key[0] in sources},
        )


def added(a: Mapping[Key, int], b: Mapping[Key, int]) -> dict[Key, int]:
    """The sums of two tallies, key by key."""
    return dict(Counter(a) + Counter(b))


def _together(a: Source, b: Source) -> Source:
    if (a.real, a.unit, a.weight) != (b.real, b.unit, b.weight):
        raise KnowledgeError(
            f"two sources are called {a.name!r}: {a.unit} of weight {a.weight} and {b.unit} of "
            f"weight {b.weight}; rename one"
        )
    return replace(
        a, categories=a.categories | b.categories, left_out=added(a.left_out, b.left_out)
    )
