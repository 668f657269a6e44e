"""`afkb why`: the chain behind a node, from pixels over axioms to probabilities."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.scene_commands import JsonOption, MapArgument


def why(
    map_folder: MapArgument,
    node: Annotated[
        str, typer.Argument(metavar="NODE", help="Id of a node, as `afkb info` shows it.")
    ],
    extensions: Annotated[
        list[Path] | None,
        typer.Option(
            "--ontology",
            metavar="FILE",
            help="An extension that the map was made with, if it is elsewhere now; repeatable.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Show why a node is in a map and is held for what it is: pixels, evidence, statements.

    Example: afkb why demo-map room-1
    """
    from afkb.explaining import explain
    from afkb.explaining.shape import explanation_json
    from afkb.store import load
    from afkb.store.made_with import knowledge_of

    stored = load(map_folder)
    found = explain(stored, node, knowledge_of(stored, extensions or []))
    if as_json:
        print_json(explanation_json(found))
        return
    from afkb.explaining.telling import statements, tables

    print_text(f"{found.id}: {found.told}")
    for name, fact in found.facts.items():
        print_text(f"  {name}: {fact}")
    for title, columns, rows in tables(found):
        print_table(columns, rows, title=title)
    for about, source in statements(found):
        print_text(f"[{about}] {source.line}")
    for note in found.notes:
        print_text(f"note: {note}")
