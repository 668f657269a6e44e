"""The command that tells where views of a recording were taken in a map: `locate`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, tell
from afkb.cli.state import state_of
from afkb_mapping.source_options import options_of

if TYPE_CHECKING:
    from afkb_mapping.localisation.questions import Answer


def locate(
    ctx: typer.Context,
    map_: Annotated[Path, typer.Argument(metavar="MAP", help="Folder that `afkb map` wrote.")],
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="Recording: a path or URI; see `afkb plugins`.")
    ],
    views: Annotated[
        int, typer.Option(min=1, help="Consecutive views that make one question.")
    ] = 1,
    start: Annotated[int, typer.Option(min=0, help="First frame to use.")] = 0,
    stop: Annotated[int | None, typer.Option(min=0, help="Frame to stop before.")] = None,
    stride: Annotated[int, typer.Option(min=1, help="Use every n-th frame.")] = 1,
    option: Annotated[
        list[str] | None,
        typer.Option(help="Option of the source, key=value; repeat for several."),
    ] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print the answers as JSON.")] = False,
) -> None:
    """Tell where in a map views were taken, with no idea of where that might be; or "lost".

    Example: afkb locate my-map new-recording/ --views 3
    """
    from afkb.flow import SkippedFrame
    from afkb_mapping.localisation.questions import answers, localiser_of
    from afkb_mapping.selection import FrameRange

    localiser = localiser_of(map_)
    opened = state_of(ctx).host.open_source(source, options_of(option or ()))
    told: list[dict[str, object]] = []
    for answer in answers(localiser, opened, FrameRange(start, stop, stride), views):
        if isinstance(answer, SkippedFrame):
            tell(f"skipped {answer.where}: {answer.why}")
        else:
            told.append(as_json(answer))
    if json_:
        print_json(told)
        return
    columns = ("stamp", "x", "y", "yaw", "probability", "")
    print_table(columns, [_row(one) for one in told], numbers=columns[:-1])


def as_json(answer: Answer) -> dict[str, object]:
    """One answer in the shape of `afkb locate --json`: map frame, m and rad."""
    found = answer.located
    known = not math.isnan(found.x)
    return {
        "stamp": answer.stamp,
        "lost": found.lost,
        "x": found.x if known else None,
        "y": found.y if known else None,
        "yaw": found.yaw if known else None,
        "probability": found.probability,
        "covariance": found.covariance.tolist() if known else None,
    }


def _row(one: dict[str, object]) -> tuple[str, ...]:
    figures = [one[k] for k in ("stamp", "x", "y", "yaw", "probability")]
    shown = [f"{f:.2f}" if isinstance(f, float) else "–" for f in figures]
    return (*shown, "lost" if one["lost"] else "")
