"""Commands that read only a map's RDF: `info` and `rooms`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from afkb.cli.output import print_json, print_table, print_text

if TYPE_CHECKING:
    from afkb.store import StoredMap

MapArgument = Annotated[
    Path, typer.Argument(metavar="MAP", help="Folder that `afkb map` wrote.", show_default=False)
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]


def info(map_folder: MapArgument, as_json: JsonOption = False) -> None:
    """Show what a map holds: its nodes by kind, its loop closures, its notes.

    Example: afkb info kitchen
    """
    from afkb.store import load
    from afkb.store.shapes import info_json

    stored = load(map_folder)
    if as_json:
        print_json(info_json(stored))
        return
    _print_kinds(stored)
    _print_things(stored)
    _print_closures(stored)
    for note in stored.notes:
        print_text(f"note: {note}")


def _print_kinds(stored: StoredMap) -> None:
    rows = [(kind, count) for kind, count in stored.kinds.items()]
    rows += [(name.replace("_", " "), count) for name, count in stored.counts.items()]
    print_table(["what", "count"], rows, title=str(stored.folder), numbers=["count"])


def _print_things(stored: StoredMap) -> None:
    from afkb.store.shapes import nodes_json
    from afkb.store.vocabulary import MAP_NODES

    columns = ["id", "kind", "affords", "x", "y", "z", "exists", "likeliest", "on", "room"]
    things = nodes_json(stored, [kind for kind in MAP_NODES if kind != "RobotPlace"])
    rows = [_thing_row(thing) for thing in things]
    if rows:
        print_table(columns, rows, numbers=["x", "y", "z", "exists"])


def _thing_row(thing: dict[str, object]) -> tuple[object, ...]:
    category = thing["category"]
    assert isinstance(category, dict)
    affords = thing["affords"]
    assert isinstance(affords, list)
    return (
        thing["id"],
        thing["kind"],
        ", ".join(affords),
        *(f"{thing[axis]:.2f}" for axis in "xyz"),
        f"{thing['existence']:.2f}",
        _likeliest(category),
        thing["supported_by"] or "",
        thing["room"] or "",
    )


def _likeliest(belief: dict[str, float]) -> str:
    name, p = next(iter(belief.items()), ("", 0.0))
    return f"{name} {p:.2f}" if name else ""


def _print_closures(stored: StoredMap) -> None:
    from afkb.store.shapes import closures_json

    rows = [
        (
            c["node"],
            c["predicted_as"],
            f"{c['probability']:.2f}",
            f"{c['displacement']:.2f}",
            c["seen_from"],
        )
        for c in closures_json(stored)
    ]
    if rows:
        columns = ["loop closed by", "predicted as", "p", "off by (m)", "seen from"]
        print_table(columns, rows, numbers=["p", "off by (m)"])


def rooms(map_folder: MapArgument, as_json: JsonOption = False) -> None:
    """Show the rooms of a map with the posterior over what each is for.

    Beside the map's own belief stand those of other room classifiers, each by its name.

    Example: afkb rooms merom --json
    """
    from afkb.store import load
    from afkb.store.shapes import rooms_json

    shapes = rooms_json(load(map_folder))
    if as_json:
        print_json(shapes)
        return
    by = list(dict.fromkeys(name for room in shapes for name in _beliefs(room, "other_beliefs")))
    columns = ["room", "area (m²)", "belief", *by, "x", "y", "visited"]
    print_table(columns, [_room_row(room, by) for room in shapes], numbers=["area (m²)", "x", "y"])


def _room_row(room: dict[str, object], by: list[str]) -> tuple[object, ...]:
    others = _beliefs(room, "other_beliefs")
    best = ", ".join(f"{name} {p:.2f}" for name, p in list(_beliefs(room, "belief").items())[:3])
    if second := _beliefs(room, "second_purpose"):
        best += f"; also {second['category']} {second['probability']:.2f}"
    return (
        room["id"],
        f"{room['area']:.1f}",
        best,
        *(_likeliest(others.get(name, {})) for name in by),
        f"{room['x']:.2f}",
        f"{room['y']:.2f}",
        "yes" if room["visited"] else "no",
    )


def _beliefs(room: dict[str, object], key: str) -> dict[str, Any]:
    found = room[key] or {}
    assert isinstance(found, dict)
    return found
