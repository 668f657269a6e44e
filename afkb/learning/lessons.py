"""What tables of homes change in the figures that the network is compiled from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from afkb.errors import KnowledgeError
from afkb.figures import Figures, Names, count_rooms, refitted
from afkb.figures.counting import Unknown
from afkb.figures.reading import Shape
from afkb.ontology.bundled import bundled_ontology


@dataclass(frozen=True, slots=True)
class Lesson:
    """One figure: P(a room of that category holds such a thing), before and after.

    `before` is None where nobody counted the category. `holding` of `rooms` own rooms hold it.
    """

    category: str
    room: str
    before: float | None
    after: float
    holding: float
    rooms: float

    @property
    def change(self) -> float:
        """How far it moved."""
        return abs(self.after - (self.before or 0.0))


@dataclass(frozen=True, slots=True)
class Lessons:
    """All figures that change, the farthest moved first; names that were not understood."""

    homes: int
    rooms: int
    things: int
    changed: tuple[Lesson, ...]
    unknown: Unknown


def learnt(tables: Sequence[Path]) -> Lessons:
    """What these tables of homes teach beside what the ontology was built from.

    Own rooms are counted; the ontology's figures are where they begin (`afkb.figures.refitting`).
    Raises `KnowledgeError` with file and line for a bad table, and
    where nothing in them can be counted.
    """
    folder = bundled_ontology().parent
    counts, unknown = count_rooms(tables, Names.load(folder / "tables"), Shape.HOMES)
    tallies = [tally for home in counts.buildings.values() for tally in home.rooms.values()]
    if not tallies:
        names = ", ".join(str(path) for path in tables)
        raise KnowledgeError(
            f"{names}: no room of a known category to learn from; name each room's category, "
            "as in `afkb ontology show rooms`"
        )
    general = _counted(folder / "counts")
    known = set(general.categories())
    changed = [
        Lesson(
            place.category,
            place.room,
            general.object_in_room(place.category, place.room).p
            if place.category in known
            else None,
            place.figure.p,
            place.figure.successes,
            place.figure.trials,
        )
        for place in refitted(general, Figures(counts))
    ]
    return Lessons(
        homes=len(counts.buildings),
        rooms=sum(tally.rooms for tally in tallies),
        things=sum(sum(tally.things.values()) for tally in tallies),
        changed=tuple(sorted(changed, key=lambda c: (-c.change, c.room, c.category))),
        unknown=unknown,
    )


@lru_cache(maxsize=1)
def _counted(folder: Path) -> Figures:
    return Figures.load(folder)
