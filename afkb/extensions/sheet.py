"""What an extension states, as rows of the ontology's own tables."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from afkb.csv_rows import Row
from afkb.ontology.schema import AFBITS, TABLES, Table

ALL_TABLES = {table.name: table for table in (*TABLES, AFBITS)}
NAMESPACE = "https://example.org/{}#"
"""The namespace of an extension that names none."""
_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|_")


@dataclass(frozen=True, slots=True)
class Entry:
    """A row, its table, and the lines of those cells that have one of their own."""

    table: Table
    row: Row
    lines: Mapping[str, int] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The name of the individual that the row states."""
        return self.table.name_of(self.row)

    def place(self, column: str) -> str:
        """File and line of a cell."""
        return f"{self.row.table}, line {self.lines.get(column, self.row.line)}"

    def filled(self, cells: Mapping[str, str]) -> Entry:
        """With these cells where it has none."""
        given = {k: v for k, v in cells.items() if v and not self.row.get(k)}
        row = Row(self.row.table, self.row.line, {**self.row.cells, **given})
        return Entry(self.table, row, self.lines)


@dataclass(slots=True)
class Sheet:
    """An extension: its name, its namespace, its rows, and the tables of its homes.

    `elsewhere`: evidence class to the count of rooms that state none, where the file says it.
    """

    file: Path
    name: str
    iri: str
    label: str
    definition: str
    license: str = ""
    entries: list[Entry] = field(default_factory=list)
    homes: list[Path] = field(default_factory=list)
    elsewhere: dict[str, float] = field(default_factory=dict)

    def of(self, *tables: str) -> list[Entry]:
        """The rows of these tables."""
        return [entry for entry in self.entries if entry.table.name in tables]


def label_of(name: str) -> str:
    """The label that a name suggests.

    >>> label_of("PlantStand")
    'plant stand'
    """
    return _WORD.sub(" ", name).lower()


def number(value: float) -> str:
    """A number as the text of a cell."""
    return repr(float(value)) if value != int(value) else str(int(value))


def rows_of(entries: Iterable[Entry]) -> list[Row]:
    """The rows by themselves."""
    return [entry.row for entry in entries]
