"""Source: CARMEN logs of laser scans and odometry."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Source

_TAGS = frozenset({b"FLASER", b"RLASER", b"ROBOTLASER1", b"ODOM", b"PARAM"})
_SNIFFED_BYTES = 65536


@hookimpl
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open a text file in which a line begins with a CARMEN tag, whatever it is called."""
    path = Path(uri)
    if "://" in uri or not path.is_file() or not _is_carmen(path):
        return None
    from afkb_carmen.source import open_log

    return open_log(uri, options)


def _is_carmen(path: Path) -> bool:
    with path.open("rb") as file:
        head = file.read(_SNIFFED_BYTES)
    return any(b"".join(line.split(None, 1)[:1]) in _TAGS for line in head.splitlines())
