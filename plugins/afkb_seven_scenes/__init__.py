"""Source: a folder of depth images with a camera pose each, as 7-Scenes lays it out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Source


@hookimpl
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open a folder that holds `frame-XXXXXX.depth.png` and the like, or nothing at all."""
    folder = Path(uri)
    if "://" in uri or not folder.is_dir():
        return None
    from afkb_seven_scenes.source import open_folder, recognises

    return open_folder(uri, options) if recognises(folder) else None
