"""Reads the tables that the ontology is built from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from afkb.csv_rows import Row, read_lines
from afkb.errors import KnowledgeError
from afkb.ontology.names import STATUSES


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
    """The header and the rows of one CSV file, which messages call `table`; nothing is checked.

    Empty cells are left out, and so may be those at the end of a row.
    """
    lines = read_lines(path, table)
    header = list(next(lines, (0, ()))[1])
    return header, [_row(table, line, header, cells) for line, cells in lines]


def _read_checked(path: Path, table: str) -> list[Row]:
    header, rows = read_file(path, table)
    if "status" in header:
        for row in rows:
            _check_provenance(row)
    return rows


def _row(table: str, line: int, header: Sequence[str], cells: Sequence[str]) -> Row:
    row = Row(table, line, {c: cell for c, cell in zip(header, cells, strict=False) if cell})
    if len(cells) > len(header):
        raise row.error(
            'more cells than the header has columns; put "…" round a cell with a comma in it'
        )
    return row


def _check_provenance(row: Row) -> None:
    if row["status"] not in STATUSES:
        raise row.error(f"status {row['status']!r} is none of: {', '.join(STATUSES)}")
    if not row["source"]:
        raise row.error("a statement names its source")
