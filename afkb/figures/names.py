"""What public tables and people call our categories and rooms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from afkb.csv_rows import Row, read_rows
from afkb.errors import KnowledgeError

SOURCES = ("hm3d", "matterport", "bddl", "procthor", "virtualhome", "oewn")
"""Where names come from; where two sources mean different things by one name, the first is held."""
HOMES = "homes"
"""Rooms that a user writes down: any name that anything here has is understood."""
UNKNOWN_ROOM = "UnknownRoom"


@dataclass(frozen=True, slots=True)
class Naming:
    """Our name for each name of each source, and for what a person may write."""

    by_source: Mapping[str, Mapping[str, str]]
    written: Mapping[str, str] = field(default_factory=dict)

    def find(self, source: str, name: str) -> str | None:
        """Our name of what the source calls so, or None; for homes, any name in any spelling."""
        if source == HOMES:
            return self.written.get(plain(name))
        return self.by_source.get(source, {}).get(name)

    def with_labels(self, labels: Mapping[str, str]) -> Naming:
        """As it is, with further names of ours and their labels that a person may write."""
        return Naming(self.by_source, _written(labels, {}) | dict(self.written))

    def known(self, source: str) -> frozenset[str]:
        """Ours of which the source has a name."""
        return frozenset(self.by_source.get(source, {}).values())


@dataclass(frozen=True, slots=True)
class Names:
    """The names of categories and of rooms."""

    categories: Naming
    rooms: Naming

    @classmethod
    def load(cls, tables: Path) -> Names:
        """The names in the ontology's tables, whatever files there are at the time.

        Raises `KnowledgeError` with file and line for a name that stands for two things of one
        source, a source that nobody knows, or a category or room that no table has.
        """
        categories = _labels(_files(tables, "categories"))
        rooms = _labels(_files(tables, "rooms"))
        rooms.pop(UNKNOWN_ROOM, None)
        return cls(
            categories=_naming(categories, _files(tables, "source_names"), "category"),
            rooms=_naming(rooms, _files(tables, "room_names"), "room"),
        )

    def with_labels(self, categories: Mapping[str, str], rooms: Mapping[str, str]) -> Names:
        """As they are, with what people may write for the terms of extensions: name to label."""
        return Names(self.categories.with_labels(categories), self.rooms.with_labels(rooms))


def plain(name: str) -> str:
    """A name without the spellings in which sources differ.

    >>> plain("Toilet#Paper"), plain("toilet_paper")
    ('toilet paper', 'toilet paper')
    """
    return " ".join(name.replace("#", " ").replace("_", " ").lower().split())


def _files(tables: Path, name: str) -> list[Path]:
    """The table of that name and those in the folder of that name."""
    single = tables / f"{name}.csv"
    found = ([single] if single.is_file() else []) + sorted((tables / name).glob("*.csv"))
    if not found:
        raise KnowledgeError(f"{single}: no such table; give the folder of the ontology's tables")
    return found


def _rows(files: list[Path], columns: tuple[str, ...]) -> Iterator[Row]:
    for path in files:
        yield from read_rows(path, columns)


def _labels(files: list[Path]) -> dict[str, str]:
    return {row["name"]: row["label"] for row in _rows(files, ("name", "label"))}


def _naming(labels: Mapping[str, str], files: list[Path], kind: str) -> Naming:
    by_source: dict[str, dict[str, str]] = {source: {} for source in SOURCES}
    for row in _rows(files, (kind, "source", "name")):
        if row["source"] not in by_source:
            raise row.error(f"source {row['source']!r} is none of: {', '.join(SOURCES)}")
        if row[kind] not in labels:
            raise row.error(f"no table has a {kind} {row[kind]!r}; add it or mend the name")
        held = by_source[row["source"]].setdefault(row["name"], row[kind])
        if held != row[kind]:
            raise row.error(
                f"{row['source']} {row['name']!r} is {held} already, and can't be {row[kind]}, "
                "too; keep one"
            )
    return Naming(by_source, _written(labels, by_source))


def _written(
    labels: Mapping[str, str], by_source: Mapping[str, Mapping[str, str]]
) -> dict[str, str]:
    written: dict[str, str] = {}
    for name in labels:
        written.setdefault(plain(name), name)
    for name, label in labels.items():
        written.setdefault(plain(label), name)
    for source in SOURCES:
        for called, name in by_source.get(source, {}).items():
            written.setdefault(plain(called), name)
    return written
