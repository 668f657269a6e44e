"""A stream of data to Rerun, where its package is installed."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from afkb.errors import PluginError

APPLICATION = "afkb"
STAMPS, VIEWS = "stamp", "view"
"""Timelines: seconds of the map's clock, and numbers of views."""
_SCHEMES = ("rerun", "rerun+http", "rerun+https")
_PORT = 9876
"""Where Rerun's viewer listens unless it is told otherwise."""
_PATIENCE_S = 3.0
_INSTEAD = "write a file with --view rerun=FILE.rrd"


def rerun() -> Any:
    """The package; `PluginError` with the way to get it where it is missing."""
    try:
        import rerun
    except ImportError as error:
        raise PluginError(
            f"rerun needs a package that is not installed ({error.name or 'rerun'}); "
            "get it, in the checkout, with: pip install -c constraints.txt -e '.[rerun]'"
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


def open_window(stream: Any) -> None:
    """Let the stream go to a window of Rerun's viewer; `PluginError` where none opens."""
    if sys.platform == "linux" and not {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys():
        raise PluginError(f"there is no display for rerun's window; {_INSTEAD}")
    path = os.environ.get("PATH", "")
    # The viewer is installed beside this Python, which need not be an activated environment.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), path])
    try:
        stream.spawn()
    except RuntimeError as error:
        reason = str(error).splitlines()[0].rstrip(".")
        raise PluginError(f"rerun's window does not open ({reason}); {_INSTEAD}") from error
    finally:
        os.environ["PATH"] = path


def connect(stream: Any, url: str) -> None:
    """Let the stream go to a viewer that runs there; `PluginError` where none answers."""
    try:
        parts = urlsplit(url)
        host, port = parts.hostname, parts.port or _PORT
    except ValueError as error:
        raise PluginError(f"--view rerun={url}: not an address ({error})") from error
    if parts.scheme not in _SCHEMES or not host:
        raise PluginError(f"--view rerun={url}: write it as rerun+http://HOST:{_PORT}/proxy")
    try:
        socket.create_connection((host, port), _PATIENCE_S).close()
    except OSError as error:
        reason = error.strerror or error
        raise PluginError(
            f"{url}: no viewer answers there ({reason}); start it, or {_INSTEAD}"
        ) from error
    stream.connect_grpc(url)
