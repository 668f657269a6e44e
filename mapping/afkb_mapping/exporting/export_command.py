"""The command that takes maps away: `export`."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.state import state_of


def export(
    ctx: typer.Context,
    map_: Annotated[
        Path | None, typer.Argument(metavar="MAP", help="Folder that `afkb map` wrote.")
    ] = None,
    to: Annotated[
        str | None, typer.Option(metavar="FORMAT", help="Format to write; see --list.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="File to write, or folder where the format has several files."),
    ] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(help="Option of the format, key=value; repeat for several."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that are there.")] = False,
    list_: Annotated[bool, typer.Option("--list", help="List the formats and stop.")] = False,
    json_: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Write a map in another format, for other tools.

    Example: afkb export my-map --to geojson --out home.geojson

    Example: afkb export --list
    """
    from afkb_mapping.exporting.export import export_map
    from afkb_mapping.source_options import options_of

    host = state_of(ctx).host
    if list_:
        _list_formats(ctx, json_)
        return
    if map_ is None or to is None:
        raise typer.BadParameter("name a map and a format: afkb export MAP --to FORMAT")
    files = export_map(map_, to, out, options_of(option or ()), force, host)
    if json_:
        written = [{"file": str(f), "bytes": f.stat().st_size} for f in files]
        print_json({"map": str(map_), "format": to, "files": written})
    else:
        for file in files:
            print_text(str(file))


def _list_formats(ctx: typer.Context, json_: bool) -> None:
    from afkb_mapping.exporting.export import formats

    found = formats(state_of(ctx).host)
    if json_:
        print_json([asdict(f) for f in found])
        return
    rows = [(f.name, f.what, ", ".join(f"{k}: {v}" for k, v in f.options.items())) for f in found]
    print_table(["format", "what", "options"], rows)
