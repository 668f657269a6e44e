"""Source: Robot@Home2, five furnished homes recorded by a robot, as its SQLite database lists them.

Written after the dataset's documents and its authors' toolbox; untested on the real data.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Source

_DATABASE = "rh.db"


@hookimpl
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open `rh.db`, or the folder that holds it."""
    path = Path(uri)
    if "://" in uri:
        return None
    if path.is_dir():
        path = path / _DATABASE
    if path.name != _DATABASE or not path.is_file():
        return None
    from afkb_robot_at_home.source import open_database

    return open_database(uri, path, options)
