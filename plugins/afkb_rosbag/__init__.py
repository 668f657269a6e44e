"""Source: ROS 1 and ROS 2 bags, read without ROS."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Source

_METADATA = "metadata.yaml"
_ENDINGS = frozenset({".bag", ".mcap", ".db3"})


@hookimpl
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open a `.bag`, `.mcap` or `.db3` file, or a folder that holds such files."""
    path = Path(uri)
    if "://" in uri or not _is_bag(path):
        return None
    from afkb_rosbag.source import open_bag

    return open_bag(uri, options)


def _is_bag(path: Path) -> bool:
    if path.is_dir():
        return any(p.suffix in _ENDINGS for p in path.iterdir()) or _is_metadata(path / _METADATA)
    return path.is_file() and path.suffix in _ENDINGS


def _is_metadata(path: Path) -> bool:
    """Whether it is ROS 2's, for others call theirs `metadata.yaml` too."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return b"rosbag2_bagfile_information" in file.read(4096)
