"""The command that maps the paper's three scenarios and judges them: `reproduce`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb_paper.reproducing import Reproduced


def reproduce(
    ctx: typer.Context,
    data: Annotated[
        Path | None,
        typer.Option(
            help="Folder with recorded homes in `homes/`; else the one that AFKB_DATA names."
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(help="Folder for the maps and the pictures of each step.")
    ] = Path("reproduced"),
    scenario: Annotated[
        list[int] | None,
        typer.Option(min=1, max=3, help="Only this one of the three; repeat for several."),
    ] = None,
    worlds: Annotated[
        bool, typer.Option("--worlds", help="Use the bundled worlds, whatever was recorded.")
    ] = False,
    json_: Annotated[bool, typer.Option("--json", help="Print the table as JSON.")] = False,
) -> None:
    """Map the paper's three scenarios and print its figures beside ours.

    Example: afkb reproduce --out reproduced
    """
    from afkb.errors import MapError
    from afkb_mapping.progress import shown_progress
    from afkb_paper.reproducing import reproduced
    from afkb_paper.scenarios import sources

    host = state_of(ctx).host
    chosen = sources(None if worlds else _homes(data), host)
    asked = {one: uri for one, uri in chosen.items() if not scenario or one.number in scenario}
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MapError(f"{out}: can't be written ({error.strerror}); name another") from error
    results = []
    for one, uri in asked.items():
        with shown_progress() as progress:
            results.append(reproduced(host, one, uri, out, progress))
        if not json_:
            _print(results[-1])
    if json_:
        print_json({"scenarios": [as_json(result) for result in results]})


def _homes(data: Path | None) -> Path | None:
    """The folder of recorded homes; None where none is named or `AFKB_DATA` has none."""
    if data is not None:
        return data / "homes" if (data / "homes").is_dir() else data
    named = os.environ.get("AFKB_DATA")
    homes = Path(named) / "homes" if named else None
    return homes if homes is not None and homes.is_dir() else None


def as_json(result: Reproduced) -> dict[str, object]:
    """One scenario in the shape of `afkb reproduce --json`."""
    return {
        "scenario": result.scenario.number,
        "title": result.scenario.title,
        "source": result.uri,
        "command": result.command,
        "map": str(result.folder),
        "pictures": str(result.sheet),
        "rows": {
            row.key: {
                "what": row.what,
                "paper": row.paper,
                "ours": row.ours,
                "how": row.how,
                "value": row.value,
            }
            for row in result.rows
        },
    }


def _print(result: Reproduced) -> None:
    columns: Sequence[str] = ("", "paper", "here", "how")
    told = [(row.what, row.paper, row.ours, row.how) for row in result.rows]
    print_table(columns, told, f"Scenario {result.scenario.number}: {result.scenario.title}")
    print_text(f"mapped by: {result.command}")
    print_text(f"pictures of each step: {result.sheet}\n")
