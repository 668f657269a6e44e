"""Reads the tables that the ontology is built from."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from afkb.errors import KnowledgeError
from afkb.ontology.names import STATUSES


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table, with the place where it stands; empty cells are left out.

    `table`: the file, from the folder of tables on, as in `categories/food.csv`.
    """

    table: str
    line: int
    cells: dict[str, str]

    @property
    def place(self) -> str:
        """File and line, for messages; the file alone for what no single line says."""
        return f"{self.table}, line {self.line}" if self.line else self.table

    def error(self, problem: str) -> KnowledgeError:
        """The error to raise about this row."""
        return KnowledgeError(f"{self.place}: {problem}")

    def __getitem__(self, column: str) -> str:
        if column not in self.cells:
            raise self.error(f"column {column!r} is empty or missing; fill it")
        return self.cells[column]

    def get(self, column: str) -> str:
        """The cell, or an empty string."""
        return self.cells.get(column, "")

    def number(self, column: str) -> float:
        """The cell as a number; `KnowledgeError` with the place where it is none."""
        try:
            return float(self[column])
        except ValueError as error:
            raise self.error(f"{column} {self[column]!r} is no number") from error

    def several(self, column: str) -> list[str]:
        """The parts of a cell that lists several things, `a|b|c`."""
        return [part.strip() for part in self.get(column).split("|") if part.strip()]


def read_table(folder: Path, name: str) -> list[Row]:
    """The rows of `name.csv`, or of every CSV file in the folder `name`, in order of file name.

    Every row that has a status has one of the known ones, and a source; `KnowledgeError` with
    file and line otherwise.
    """
    path = folder / f"{name}.csv"
    if path.is_file():
        return _read_checked(path, path.name)
    parts = sorted((folder / name).glob("*.csv"))
    if not parts:
        raise KnowledgeError(f"{path}: no such table; the ontology is built from it")
    return [row for part in parts for row in _read_checked(part, f"{name}/{part.name}")]


def by_name(rows: Iterable[Row]) -> dict[str, Row]:
    """The rows by their name; `KnowledgeError` where two share one."""
    found: dict[str, Row] = {}
    for row in rows:
        if row["name"] in found:
            first = found[row["name"]].place
            raise row.error(f"{row['name']} is stated a second time, after {first}; keep one")
        found[row["name"]] = row
    return found


def read_file(path: Path, table: str) -> tuple[list[str], list[Row]]:
    """The header and the rows of one CSV file, which messages call `table`; nothing is checked."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.DictReader(file, strict=True)
            header = list(reader.fieldnames or ())
            rows = [_row(table, reader, cells) for cells in reader]
    except (csv.Error, UnicodeDecodeError) as error:
        raise KnowledgeError(f"{table}: not readable as CSV: {error}; save it as UTF-8") from error
    return header, rows


def _read_checked(path: Path, table: str) -> list[Row]:
    header, rows = read_file(path, table)
    if "status" in header:
        for row in rows:
            _check_provenance(row)
    return rows


def _row(table: str, reader: csv.DictReader[str], cells: dict[str, str | list[str]]) -> Row:
    if None in cells:
        raise KnowledgeError(
            f"{table}, line {reader.line_num}: more cells than the header has columns; "
            'put "…" round a cell with a comma in it'
        )
    return Row(table, reader.line_num, {k: v for k, v in cells.items() if isinstance(v, str) and v})


def _check_provenance(row: Row) -> None:
    if row["status"] not in STATUSES:
        raise row.error(f"status {row['status']!r} is none of: {', '.join(STATUSES)}")
    if not row["source"]:
        raise row.error("a statement names its source")
