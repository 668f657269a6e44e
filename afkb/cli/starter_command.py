"""`afkb ontology new`: starts an extension."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import print_text, tell
from afkb.starters import Kind


def new(
    path: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="To write: .yaml, .csv, .owl, or a folder."),
    ],
    kind: Annotated[
        Kind | None, typer.Option(help="What to write.  [default: as the name tells]")
    ] = None,
) -> None:
    """Start an extension: a commented file that passes the check as it is, to be changed.

    Example: afkb ontology new my-home.yaml
    """
    from afkb.starters import write_starter

    for file in write_starter(path, kind):
        print_text(str(file))
    tell(f"change it, then: afkb ontology check {path}")
