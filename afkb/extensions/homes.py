"""Homes that an extension brings: their rooms counted in, and what follows for the figures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

from afkb.csv_rows import Row
from afkb.extensions.sheet import Sheet
from afkb.extensions.terms import Term, Terms
from afkb.figures import Figures, Names, count_rooms, refitted
from afkb.ontology.counted import IN_ROOM, in_room_row
from afkb.ontology.names import AFN
from afkb.ontology.schema import Table


def home_rows(sheet: Sheet, terms: Terms, tables: Path) -> Iterator[tuple[Table, Row]]:
    """A figure for each category and room met in the homes, refitted from the ontology's.

    That a room of theirs lacks what another has counts, too. They are the extension's own: the
    ontology's figure of the same thing and room stays beside, and is not read any more.
    `tables`: the folder of the ontology's tables, which knows what people call things.
    """
    if not sheet.homes:
        return
    homes = count_homes(sheet.homes, terms, tables)
    bundled = tables.parent / "counts"
    found = refitted(_general(bundled), homes) if bundled.is_dir() else homes.in_rooms(least=0)
    brought = " + ".join(path.name for path in sheet.homes)
    for place in found:
        row = in_room_row(place)
        cells = row.cells | {"source": f"counted in {place.figure.source}: {brought}"}
        yield IN_ROOM, Row(brought, 0, cells)


@lru_cache(maxsize=1)
def _general(folder: Path) -> Figures:
    return Figures.load(folder)


def count_homes(homes: list[Path], terms: Terms, tables: Path) -> Figures:
    """The figures of these homes alone; names of the terms' own namespaces are understood."""
    names = Names.load(tables).with_labels(
        {term.name: _words(term.name) for term in _new(terms, "category")},
        {term.name: _words(term.name) for term in _new(terms, "room")},
    )
    return Figures(count_rooms(homes, names)[0])


def _new(terms: Terms, word: str) -> list[Term]:
    return [t for t in terms.by_word.get(word, {}).values() if not t.iri.startswith(AFN)]


def _words(name: str) -> str:
    """What people write for a name.

    >>> _words("CactusStand")
    'cactus stand'
    """
    return re.sub(r"(?<!^)(?=[A-Z])", " ", name).lower()
