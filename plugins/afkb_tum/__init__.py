"""Source: a folder in the layout of the TUM RGB-D benchmark (`depth.txt`, `groundtruth.txt`)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.errors import SourceError
from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Source

_PACKED = (".tgz", ".tar.gz")


@hookimpl
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open a folder with `depth.txt` or an association file; say so of one that is still packed."""
    path = Path(uri)
    if "://" in uri:
        return None
    if path.name.endswith(_PACKED) and path.is_file():
        raise SourceError(f"{path}: is packed; unpack it with `tar xzf` and name its folder")
    if not path.is_dir():
        return None
    from afkb_tum.layout import recognises

    if not recognises(path):
        return None
    from afkb_tum.source import open_folder

    return open_folder(uri, options)
