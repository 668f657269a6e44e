"""CSV files row by row, with the place of each row for messages; and rows as CSV text."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from afkb.errors import KnowledgeError

LONGEST_CELL = 16_000_000
"""Characters; a pair that is common has a long list of buildings."""


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table, with the place where it stands.

    `table`: the file as messages call it, as in `categories/food.csv`. `cells`: column to cell;
    those of the ontology's tables leave empty cells out.
    """

    table: str
    line: int
    cells: dict[str, str]

    @property
    def place(self) -> str:
        """File and line, for messages; the file alone for what no single line says."""
        return f"{self.table}, line {self.line}" if self.line else self.table

    def error(self, problem: str) -> KnowledgeError:
        """The error to raise about this row; `problem` says what is wrong and the mend."""
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

    def whole(self, column: str) -> int:
        """The cell as a whole number, 0 or more."""
        return self.whole_number(self[column], column)

    def whole_number(self, text: str, what: str) -> int:
        """A text of this row as a whole number, 0 or more."""
        if not (text.isascii() and text.isdigit() and len(text) < 10):
            raise self.error(f"{what} is {text!r}; write a whole number, as in 3")
        return int(text)

    def several(self, column: str) -> list[str]:
        """The parts of a cell that lists several things, `a|b|c`."""
        return [part.strip() for part in self.get(column).split("|") if part.strip()]


def read_rows(path: Path, columns: Sequence[str] = (), table: str | None = None) -> Iterator[Row]:
    """The rows of a CSV file that has at least these columns, one by one, empty cells and all.

    `table`: what messages call the file; its path, if nothing else. Every row has as many cells as
    the header. Raises `KnowledgeError` with file and line for what is no such file.
    """
    called = str(path) if table is None else table
    lines = read_lines(path, called)
    header = _header(lines, called)
    missing = [column for column in columns if column not in header]
    if missing:
        raise KnowledgeError(
            f"{called}, line 1: no column {', '.join(missing)}; "
            f"the header needs {','.join(columns)}"
        )
    for line, cells in lines:
        row = Row(called, line, dict(zip(header, cells, strict=False)))
        if len(cells) != len(header):
            raise row.error(
                f"{len(cells)} cells where the header has {len(header)}; quote cells with commas"
            )
        yield row


def read_header(path: Path) -> Sequence[str]:
    """The columns of a CSV file."""
    return _header(read_lines(path, str(path)), str(path))


def _header(lines: Iterator[tuple[int, Sequence[str]]], called: str) -> Sequence[str]:
    for _, header in lines:
        return header
    raise KnowledgeError(f"{called}, line 1: is empty; the first line names the columns")


def read_lines(path: Path, table: str) -> Iterator[tuple[int, Sequence[str]]]:
    """The number and the cells of every line, the header's first; blank lines are skipped."""
    csv.field_size_limit(max(csv.field_size_limit(), LONGEST_CELL))
    line = 0
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            for cells in reader:
                line = reader.line_num
                if cells:
                    yield line, cells
    except OSError as error:
        raise KnowledgeError(f"{table}: can't be read: {error.strerror}; check the path") from error
    except (UnicodeDecodeError, csv.Error) as error:
        what = "isn't UTF-8 text" if isinstance(error, UnicodeDecodeError) else f"no CSV ({error})"
        raise KnowledgeError(f"{table}, after line {line}: {what}; save it as UTF-8 CSV") from error


def csv_text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A header and rows as the text of a CSV file: the same bytes for the same rows."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return out.getvalue()
