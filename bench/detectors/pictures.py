"""Pictures that a person can check: what detectors say, drawn over the depth image."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import cv2

from afkb.flow import View
from afkb_mapping.one_per_thing import one_per_thing
from afkb_mapping.overlay import overlay
from bench.detectors.seen import CLAIMED, Run

PICTURES = 8
"""Views drawn of each recording, evenly over it."""


def draw_views(name: str, views: Iterable[View], seen: Run, folder: Path) -> int:
    """Write `NAME-INDEX.png` for some of the views that were seen; returns how many."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = {i for i, _ in seen.views[:: max(1, -(-len(seen.views) // PICTURES))]}
    said, drawn = dict(seen.views), 0
    for view in views:
        if view.index in wanted and view.index in said:
            path = folder / f"{name}-{view.index:04d}.png"
            cv2.imwrite(str(path), overlay(view, one_per_thing(said[view.index]), CLAIMED))
            drawn += 1
    return drawn
