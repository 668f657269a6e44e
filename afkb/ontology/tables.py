"""Reads the tables that the ontology is built from."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from afkb.errors import KnowledgeError
from afkb.ontology.names import STATUSES


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table, with the place where it stands; empty cells are left out."""

    table: str
    line: int
    cells: dict[str, str]

    @property
    def place(self) -> str:
        """File and line, for messages."""
        return f"{self.table}.csv, line {self.line}"

    def __getitem__(self, column: str) -> str:
        if column not in self.cells:
            raise KnowledgeError(f"{self.place}: column {column!r} is empty or missing; fill it")
        return self.cells[column]

    def get(self, column: str) -> str:
        """The cell, or an empty string."""
        return self.cells.get(column, "")

    def number(self, column: str) -> float:
        """The cell as a number; `KnowledgeError` with the place where it is none."""
        try:
            return float(self[column])
        except ValueError as error:
            raise KnowledgeError(f"{self.place}: {column} {self[column]!r} is no number") from error


def read_table(folder: Path, name: str) -> list[Row]:
    """The rows of a table; every row that has a status has one of the known ones, and a source."""
    path = folder / f"{name}.csv"
    if not path.is_file():
        raise KnowledgeError(f"{path}: no such table; the ontology is built from it")
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        rows = [
            Row(name, reader.line_num, {k: v for k, v in cells.items() if k and v})
            for cells in reader
        ]
    for row in rows:
        if "status" in (reader.fieldnames or ()):
            _check_provenance(row)
    return rows


def _check_provenance(row: Row) -> None:
    if row["status"] not in STATUSES:
        raise KnowledgeError(
            f"{row.place}: status {row['status']!r} is none of: {', '.join(STATUSES)}"
        )
    if not row["source"]:
        raise KnowledgeError(f"{row.place}: a statement names its source")
