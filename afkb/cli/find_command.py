"""`afkb find`: where in a map a thing of some kind is or would be."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.scene_commands import JsonOption, MapArgument
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb.finding import Region

ROWS = 15
"""Rows of a table; JSON has all that is likely enough."""


def find(
    ctx: typer.Context,
    map_folder: MapArgument,
    object_: Annotated[
        str, typer.Argument(metavar="OBJECT", help="A kind of thing, as in mug, or a group.")
    ],
    at_least: Annotated[
        float, typer.Option(min=0.0, max=1.0, metavar="P", help="Leave out what is less likely.")
    ] = 0.001,
    extensions: Annotated[
        list[Path] | None,
        typer.Option("--ontology", metavar="FILE", help="An extension to know of; repeatable."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Find where such a thing is or would be: places in order of how likely one is there.

    Example: afkb find my-map mug
    """
    from afkb.finding import Surroundings, category_named, regions, somewhere
    from afkb.finding.names import label_of
    from afkb.store import load

    kb = state_of(ctx).host.knowledge_base
    kb = kb.extended(extensions) if extensions else kb
    around = Surroundings.of(load(map_folder))
    category = category_named(object_, kb)
    found = regions(category, around, kb)
    likely = [region for region in found if region.probability >= at_least]
    if as_json:
        print_json([region_json(region) for region in likely])
        return
    _print_regions(likely, label_of(category, kb))
    print_text(f"somewhere in this map: {somewhere(found):.2f}")


def region_json(region: Region) -> dict[str, object]:
    """A region in the shape of `afkb find --json`: m, map frame."""
    return {
        "x": round(region.x, 3),
        "y": round(region.y, 3),
        "z": round(region.z, 3),
        "probability": round(region.probability, 4),
        "seen": region.seen,
        "reason": region.reason,
        "node": region.node,
        "how": region.how,
        "room": region.room,
    }


def _print_regions(found: list[Region], label: str) -> None:
    rows = [(f"{r.probability:.3f}", r.how, r.room or "", *_at(r), r.reason) for r in found[:ROWS]]
    columns = ["p", "what", "in", "x", "y", "z", "why"]
    print_table(columns, rows, title=f"where a {label} may be", numbers=["p", "x", "y", "z"])
    if len(found) > ROWS:
        print_text(f"and {len(found) - ROWS} less likely places: see --json")


def _at(region: Region) -> tuple[str, str, str]:
    return f"{region.x:.2f}", f"{region.y:.2f}", f"{region.z:.2f}"
