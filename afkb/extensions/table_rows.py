"""An extension in CSV tables: a folder of them, or one file, with the ontology's own columns."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

from afkb.csv_rows import Row, read_header
from afkb.errors import KnowledgeError
from afkb.extensions.problems import Problems, nearest_of
from afkb.extensions.sheet import ALL_TABLES, NAMESPACE, Entry, Sheet
from afkb.ontology.names import slug
from afkb.ontology.tables import read_file

_MORE_COLUMNS = {"afbits": {"part", "pose", "scale"}}
"""Columns that a table may have though the bundled one has no use for them."""
HOMES = "homes"
"""A folder of tables of what homes hold, rather than of the ontology."""


def tables_sheet(path: Path, tables: Path, problems: Problems) -> Sheet:
    """The rows of a folder of tables, or of one table; what is wrong goes to `problems`.

    `tables`: the folder of the bundled tables, whose columns an extension's tables have, too.
    """
    name = slug(path.stem)
    sheet = Sheet(path, name, NAMESPACE.format(name), name, "")
    headers = _headers(tables)
    files = _files(path)
    if not files:
        known = ", ".join(headers)
        raise KnowledgeError(
            f"{path}: no extension: no table in this folder; name its files after the ontology's "
            f"tables, as in categories.csv; there are {known}"
        )
    for file, table in files:
        label = path.name if file == path else f"{path.name}/{file.relative_to(path).as_posix()}"
        with problems.noting():
            sheet.entries += _entries(file, label, table, headers, problems)
    if path.is_dir():
        sheet.homes = sorted((path / HOMES).glob("*.csv"))
    return sheet


def _files(path: Path) -> list[tuple[Path, str | None]]:
    """Each file with the table that its place names."""
    if path.is_file():
        return [(path, None)]
    flat: list[tuple[Path, str | None]] = [(p, None) for p in sorted(path.glob("*.csv"))]
    deep: list[tuple[Path, str | None]] = [
        (p, p.parent.name) for p in sorted(path.glob("*/*.csv")) if p.parent.name in ALL_TABLES
    ]
    return flat + deep


def _entries(
    file: Path, label: str, table: str | None, headers: dict[str, list[str]], problems: Problems
) -> Iterator[Entry]:
    header, rows = read_file(file, label)
    if not header:
        raise KnowledgeError(f"{label}: empty; start it with the columns of one of the tables")
    name = table or _table_of(file, header, headers, label)
    allowed = {*headers[name], *_MORE_COLUMNS.get(name, ())}
    if len(header) == 1 and (mark := next((m for m in ";\t" if m in header[0]), "")):
        said = "a tab" if mark == "\t" else repr(mark)
        raise KnowledgeError(f"{label}, line 1: columns are parted by {said}; part them by commas")
    for number, column in enumerate(header):
        if column not in allowed:
            problems.add(
                f"{label}, line 1", f"unknown column {column!r}; {nearest_of(column, allowed)}"
            )
        elif column in header[:number]:
            problems.add(f"{label}, line 1", f"column {column} is there twice; take one out")
    for row in rows:
        cells = {column: cell.strip() for column, cell in row.cells.items() if cell.strip()}
        if cells:
            yield Entry(ALL_TABLES[name], Row(label, row.line, cells))


def _table_of(file: Path, header: list[str], headers: dict[str, list[str]], label: str) -> str:
    """The table that a file's name ends in, else the only one that has all of its columns."""
    stem = file.stem.replace("-", "_").lower()
    named = [name for name in headers if stem == name or stem.endswith(f"_{name}")]
    if named:
        return max(named, key=len)
    fitting = [name for name, columns in headers.items() if set(header) <= set(columns)]
    if len(fitting) == 1:
        return fitting[0]
    raise KnowledgeError(
        f"{label}: no extension: neither its name nor its columns tell which table it is; end its "
        f"name in one of {', '.join(headers)}, as in my-categories.csv"
    )


@cache
def _headers(tables: Path) -> dict[str, list[str]]:
    """The columns of every table of the ontology."""
    found = {}
    for name in ALL_TABLES:
        parts = [tables / f"{name}.csv", *sorted((tables / name).glob("*.csv"))]
        for part in (p for p in parts if p.is_file()):
            found[name] = list(read_header(part))
            break
    return found
