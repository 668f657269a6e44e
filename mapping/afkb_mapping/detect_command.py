"""The command that shows what single frames give: `detect`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from afkb.cli.output import print_json, print_table, tell
from afkb.cli.state import state_of
from afkb.errors import MapError
from afkb_mapping.source_options import options_of

if TYPE_CHECKING:
    from afkb.flow import SkippedFrame
    from afkb_mapping.frame_report import Look

LISTED_FEATURES = 4
LISTED_FROM = 0.3
"""The table leaves fainter features out; `--json` has them all."""


def detect(
    ctx: typer.Context,
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="Recording: a path or URI; see `afkb plugins`.")
    ],
    frame: Annotated[int, typer.Option(min=0, help="First frame to look at.")] = 0,
    count: Annotated[int, typer.Option(min=1, help="How many frames.")] = 1,
    stride: Annotated[int, typer.Option(min=1, help="Take every n-th of them.")] = 1,
    detector: Annotated[
        list[str] | None, typer.Option(help="Use only this detector; repeat for several.")
    ] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(help="Option of the source, key=value; repeat for several."),
    ] = None,
    ontology: Annotated[
        list[Path] | None, typer.Option(help="File that extends the ontology; repeatable.")
    ] = None,
    pictures: Annotated[
        Path | None, typer.Option(help="Folder for a picture of each frame, with what was seen.")
    ] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print all that is known of each.")] = False,
) -> None:
    """Show what the detectors see in single frames: what it affords, where, and what it may be.

    Example: afkb detect my-recording/ --frame 40 --pictures seen
    """
    from afkb.inference import network_of
    from afkb.plugins.host import PluginHost
    from afkb_mapping.frame_report import as_json, looks
    from afkb_mapping.selection import FrameRange

    host = PluginHost(extensions=ontology) if ontology else state_of(ctx).host
    frames = FrameRange(frame, frame + count * stride, stride)
    network = network_of(host.knowledge_base)
    told = []
    for look in looks(host, source, frames, tuple(detector or ()), options_of(option or ())):
        told.append(as_json(look, network))
        if pictures is not None:
            _draw(look, pictures)
    if json_:
        print_json(told)
        return
    for one in told:
        _print(one)
    if pictures is not None:
        tell(f"pictures in {pictures}")


def _print(one: dict[str, object]) -> None:
    if "skipped" in one:
        tell(f"skipped {one['skipped']}")
        return
    detections = one["detections"]
    assert isinstance(detections, list)
    print_table(
        ("affords", "x", "y", "z", "size", "scale", "may be", "", "px"),
        [_row(d) for d in detections],
        title=f"frame {one['frame']}",
        numbers=("x", "y", "z", "px"),
    )


def _row(d: dict[str, Any]) -> tuple[str, ...]:
    ranked = sorted(d["affords"].items(), key=lambda pair: (-pair[1], pair[0]))
    named = [(n, p) for n, p in ranked if p >= LISTED_FROM] or ranked[:1]
    affords = ", ".join(f"{n} {p:.2f}" for n, p in named[:LISTED_FEATURES])
    more = len(named) - LISTED_FEATURES
    best = next(iter(d.get("category", {}).items()), None)
    return (
        affords + (f", {more} more" if more > 0 else ""),
        *(f"{d[axis]:.2f}" for axis in "xyz"),
        " × ".join(f"{side:.2f}" for side in d["size"]),
        str(d.get("scale", "")),
        f"{best[0]} {best[1]:.2f}" if best else "",
        str(d.get("movability", "")),
        str(d["pixels"]),
    )


def _draw(look: Look | SkippedFrame, folder: Path) -> None:
    import cv2

    from afkb.flow import SkippedFrame
    from afkb_mapping.overlay import overlay

    if isinstance(look, SkippedFrame) or look.view.depth_m is None:
        return
    path = folder / f"frame-{look.view.index:06d}.png"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        written = cv2.imencode(".png", overlay(look.view, look.detections))[1]
        path.write_bytes(written.tobytes())
    except OSError as error:
        raise MapError(
            f"{path}: can't be written ({error.strerror}); name another folder"
        ) from error
