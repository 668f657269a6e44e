"""A stream of data to Rerun, where its package is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from afkb.errors import PluginError

APPLICATION = "afkb"
STAMPS, VIEWS = "stamp", "view"
"""Timelines: seconds of the map's clock, and numbers of views."""


def rerun() -> Any:
    """The package; `PluginError` with the way to get it where it is missing."""
    try:
        import rerun
    except ImportError as error:
        raise PluginError(
            f"rerun needs a package that is not installed ({error.name or 'rerun'}); "
            "get it with: pip install 'afkb[rerun]'"
        ) from error
    return rerun


def new_stream(name: str) -> Any:
    """A stream that goes nowhere yet, by the name of what it shows."""
    rr = rerun()
    stream = rr.RecordingStream(APPLICATION, recording_id=name, send_properties=False)
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    return stream


def save_to(stream: Any, path: Path) -> None:
    """Let the stream go to a file; `PluginError` where that can't be written."""
    try:
        with path.open("xb"):
            pass
        stream.save(path)
    except FileExistsError as error:
        raise PluginError(f"{path}: is there already; name another file") from error
    except (OSError, RuntimeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise PluginError(f"{path}: can't be written ({reason}); name another file") from error
