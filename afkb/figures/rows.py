"""Reads CSV files row by row; a message about a row says its file and line."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from afkb.errors import KnowledgeError

LONGEST_CELL = 16_000_000
"""Characters; a pair that is common has a long list of buildings."""


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a CSV file, with the place where it stands."""

    path: Path
    line: int
    cells: dict[str, str]

    def __getitem__(self, column: str) -> str:
        return self.cells[column]

    def error(self, what: str) -> KnowledgeError:
        """An error that names this row's file and line; `what` says what is wrong and the mend."""
        return KnowledgeError(f"{self.path}, line {self.line}: {what}")

    def whole(self, column: str) -> int:
        """The cell as a whole number, 0 or more."""
        return self.whole_number(self[column], column)

    def whole_number(self, text: str, what: str) -> int:
        """A text of this row as a whole number, 0 or more."""
        if not (text.isascii() and text.isdigit() and len(text) < 10):
            raise self.error(f"{what} is {text!r}; write a whole number, as in 3")
        return int(text)


def read_header(path: Path) -> tuple[str, ...]:
    """The columns of a CSV file."""
    return next(_cells(path))[1]


def read_rows(path: Path, columns: Sequence[str]) -> Iterator[Row]:
    """The rows of a CSV file that has at least these columns, one by one; blank lines are skipped.

    Raises `KnowledgeError` with file and line for what is no such file.
    """
    lines = _cells(path)
    header = next(lines)[1]
    missing = [column for column in columns if column not in header]
    if missing:
        raise KnowledgeError(
            f"{path}, line 1: no column {', '.join(missing)}; the header needs {','.join(columns)}"
        )
    for line, cells in lines:
        row = Row(path, line, dict(zip(header, cells, strict=False)))
        if len(cells) != len(header):
            raise row.error(
                f"{len(cells)} cells where the header has {len(header)}; quote cells with commas"
            )
        yield row


def _cells(path: Path) -> Iterator[tuple[int, tuple[str, ...]]]:
    csv.field_size_limit(max(csv.field_size_limit(), LONGEST_CELL))
    line = 0
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            for cells in reader:
                line = reader.line_num
                if cells:
                    yield line, tuple(cells)
    except OSError as error:
        raise KnowledgeError(f"{path}: can't be read: {error.strerror}; check the path") from error
    except (UnicodeDecodeError, csv.Error) as error:
        what = "isn't UTF-8 text" if isinstance(error, UnicodeDecodeError) else f"no CSV ({error})"
        raise KnowledgeError(f"{path}, after line {line}: {what}; save it as UTF-8 CSV") from error
    if not line:
        raise KnowledgeError(f"{path}, line 1: is empty; the first line names the columns")
