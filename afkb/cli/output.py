"""How commands print results: tables for people, JSON and text for programs; all to stdout."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Sequence

import typer

_WIDTH_WITHOUT_TERMINAL = 200


def print_json(value: object) -> None:
    """Print a value as JSON and nothing else, in ASCII, so that it passes through any pipe."""
    typer.echo(json.dumps(value, indent=1, allow_nan=False))


def print_text(text: str) -> None:
    """Print text as it is."""
    typer.echo(text, nl=not text.endswith("\n"))


def print_table(
    columns: Sequence[str],
    rows: Iterable[Sequence[object]],
    title: str | None = None,
    numbers: Iterable[str] = (),
) -> None:
    """Print a table; cells are shown as `str` gives them, `numbers` names right-aligned columns."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    right = set(numbers)
    table = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for column in columns:
        justify = "right" if column in right else "left"
        table.add_column(column, justify=justify, overflow="fold")  # type: ignore[arg-type]
    for row in rows:
        table.add_row(*(Text(str(cell)) for cell in row))
    width = None if sys.stdout.isatty() else _WIDTH_WITHOUT_TERMINAL
    Console(width=width, highlight=False).print(table)


def tell(message: str) -> None:
    """Say something to the person, on stderr, so that stdout stays the result."""
    typer.echo(message, err=True)
