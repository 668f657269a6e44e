"""`afkb find`: where in a map a thing of some kind is or would be."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.scene_commands import JsonOption, MapArgument

if TYPE_CHECKING:
    from afkb.finding import Region, Surroundings
    from afkb.finding.grasping import Grasp
    from afkb.knowledge import AfNet

ROWS = 15
"""Rows of a table; JSON has all that is likely enough."""


def find(
    map_folder: MapArgument,
    object_: Annotated[
        str, typer.Argument(metavar="OBJECT", help="A kind of thing, as in mug, or a group.")
    ],
    at_least: Annotated[
        float, typer.Option(min=0.0, max=1.0, metavar="P", help="Leave out what is less likely.")
    ] = 0.001,
    grasp: Annotated[
        bool, typer.Option("--grasp", help="How to grasp what was seen and may be one.")
    ] = False,
    extensions: Annotated[
        list[Path] | None,
        typer.Option(
            "--ontology",
            metavar="FILE",
            help="An extension, in place of those the map was made with; repeatable.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Find where such a thing is or would be: places in order of how likely one is there.

    Example: afkb find my-map mug --grasp
    """
    from afkb.finding import Surroundings, category_named, regions, somewhere
    from afkb.finding.names import label_of
    from afkb.store import load
    from afkb.store.made_with import knowledge_of

    stored = load(map_folder)
    kb, around = knowledge_of(stored, extensions or []), Surroundings.of(stored)
    category = category_named(object_, kb)
    found = regions(category, around, kb)
    if grasp:
        _grasp(category, found, around, kb, at_least, as_json)
        return
    likely = [region for region in found if region.probability >= at_least]
    if as_json:
        print_json([region_json(region) for region in likely])
        return
    _print_regions(likely, label_of(category, kb))
    print_text(f"somewhere in this map: {somewhere(found):.2f}")


def _grasp(
    category: str,
    found: list[Region],
    around: Surroundings,
    kb: AfNet,
    at_least: float,
    as_json: bool,
) -> None:
    """Print the ways to grasp it; those that fit but leave no room for a hand come last."""
    from afkb.finding.grasping import CLEAR, grasps, is_graspable
    from afkb.finding.names import label_of

    ways = grasps(category, found, around, kb)
    clear = [way for way in ways if way.clear >= CLEAR and way.probability >= at_least]
    tight = [way for way in ways if way.clear < CLEAR and way.is_one * way.fits >= at_least]
    tight.sort(key=lambda way: -way.is_one * way.fits)
    if as_json:
        print_json([grasp_json(way) for way in clear + tight])
        return
    label = label_of(category, kb)
    if not ways:
        known = "nothing seen may be one" if is_graspable(category, kb) else "no grasp is known"
        print_text(f"{label}: {known}")
        return
    _print_grasps(clear, f"how to grasp a {label}")
    if tight:
        _print_grasps(tight, "would fit with p, but there is no room for a hand", False)


def grasp_json(way: Grasp) -> dict[str, object]:
    """A grasp in the shape of `afkb find --grasp --json`: m and rad, map frame."""
    return {
        "node": way.node.id,
        "x": round(way.node.x, 3),
        "y": round(way.node.y, 3),
        "z": round(way.node.z, 3),
        "grasp": way.grasp,
        "part": way.part,
        "approach": way.approach,
        "bearing": None if way.bearing is None else round(way.bearing, 4),
        "closing": None if way.closing is None else round(way.closing, 4),
        "width": None if way.width is None else round(way.width, 4),
        "probability": round(way.probability, 4),
        "is_one": round(way.is_one, 4),
        "fits": round(way.fits, 4),
        "clear": round(way.clear, 4),
        "reason": way.reason,
    }


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
        "parts": [[round(x, 3), round(y, 3), round(share, 4)] for x, y, share in region.parts],
    }


def _print_regions(found: list[Region], label: str) -> None:
    rows = [(f"{r.probability:.3f}", r.how, r.room or "", *_at(r), r.reason) for r in found[:ROWS]]
    columns = ["p", "what", "in", "x", "y", "z", "why"]
    print_table(columns, rows, title=f"where a {label} may be", numbers=["p", "x", "y", "z"])
    if len(found) > ROWS:
        print_text(f"and {len(found) - ROWS} less likely places: see --json")


def _at(region: Region) -> tuple[str, str, str]:
    return f"{region.x:.2f}", f"{region.y:.2f}", f"{region.z:.2f}"


def _print_grasps(ways: list[Grasp], title: str, clear: bool = True) -> None:
    rows = [
        (
            f"{way.probability if clear else way.is_one * way.fits:.3f}",
            way.node.id,
            way.grasp,
            way.part or "whole",
            way.approach,
            "" if way.width is None else f"{way.width:.3f}",
            way.reason,
        )
        for way in ways[:ROWS]
    ]
    columns = ["p", "thing", "grasp", "at", "from", "width", "why"]
    print_table(columns, rows, title=title, numbers=["p", "width"])
    if len(ways) > ROWS:
        print_text(f"and {len(ways) - ROWS} less likely ways: see --json")
