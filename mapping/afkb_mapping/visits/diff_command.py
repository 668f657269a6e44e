"""The command that tells what has changed between two visits: `diff`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, tell

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from afkb.store.shapes import Json


def diff(
    first: Annotated[Path, typer.Argument(metavar="MAP1", help="Map of an earlier visit.")],
    second: Annotated[
        Path, typer.Argument(metavar="MAP2", help="Map of a later one, or MAP1 updated by it.")
    ],
    transform: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,YAW",
            help="Where MAP2's origin lies in MAP1's frame, m and degrees; else it is located.",
        ),
    ] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print all of it as JSON.")] = False,
) -> None:
    """Tell what moved, vanished and appeared between two visits, and what nobody looked at.

    Example: afkb diff my-map my-map-later
    """
    from afkb_mapping.visits.diff import diff as difference_of

    found = difference_of(first, second, None if transform is None else _transform(transform))
    if json_:
        print_json(found.as_json())
        return
    rows = [("moved", *_told(a), f"from {_place(b)}") for b, a in found.moved]
    for what in ("vanished", "appeared", "unknown"):
        rows += [(what, *_told(node), "") for node in getattr(found, what)]
    print_table(("", "id", "what", "at", "room", ""), rows)
    tell(f"{len(found.unchanged)} things unchanged")


def _transform(text: str) -> NDArray[np.float64]:
    from afkb_mapping.geometry import T_from_xy_yaw

    try:
        x, y, degrees = (float(part) for part in text.split(","))
    except ValueError as error:
        raise typer.BadParameter(f"--transform {text}: write it as X,Y,YAW (m, m, °)") from error
    return T_from_xy_yaw(x, y, math.radians(degrees))


def _told(node: Json) -> tuple[str, str, str, str]:
    belief = node["category"]
    assert isinstance(belief, dict)
    likeliest = max(belief, key=lambda name: belief[name], default="")
    return str(node["id"]), likeliest, _place(node), str(node["room"] or "")


def _place(node: Json) -> str:
    return f"{node['x']:.2f}, {node['y']:.2f}, {node['z']:.2f}"
