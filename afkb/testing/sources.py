"""The contract of a source."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

import numpy as np

from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb.testing.require import require, same

_FARTHEST_M = 60.0


def check_source(source: Source, at_most: int = 8) -> None:
    """Raise unless the source keeps its contract over its first `at_most` frames.

    Lazy, re-readable with the same result, frames counted from 0 and in time order, depth in
    metres, transforms rigid, not yet placed in a map.
    """
    who = f"source {getattr(source, 'uri', '?')}"
    require(isinstance(source, Source), who, "is no Source", "see afkb.plugins.protocols.Source")
    require(isinstance(source.gravity_aligned, bool), who, "gravity_aligned", "make it a bool")
    require(len(source) > 0, who, "has no frame", "raise SourceError when there is nothing to read")
    views = source.views()
    require(iter(views) is views, who, "views() is no iterator", "make it a generator, for memory")
    first = list(islice(views, at_most))
    _check_frames(first, who)
    again = list(islice(source.views(), at_most))
    require(same(first, again), who, "reads differently the second time", "keep no reading state")
    _check_slices(source, first, who)


def _check_frames(frames: Sequence[View | SkippedFrame], who: str) -> None:
    require(len(frames) > 0, who, "yields nothing", "yield a View or a SkippedFrame for each frame")
    for i, frame in enumerate(frames):
        require(
            isinstance(frame, (View, SkippedFrame)), who, f"frame {i}", "yield View or SkippedFrame"
        )
        require(frame.index == i, who, f"frame {i} says index {frame.index}", "count from 0")
        if isinstance(frame, View):
            _check_view(frame, who)
        else:
            explained = bool(frame.where and frame.why)
            require(explained, who, f"frame {i} is skipped unexplained", "say where and why")
    good = [f for f in frames if isinstance(f, View)]
    require(len(good) > 0, who, f"none of {len(frames)} frames is usable", "see why they skip")
    stamps = [f.stamp for f in good]
    require(stamps == sorted(stamps), who, "stamps run backwards", "yield frames in time order")


def _check_view(view: View, who: str) -> None:
    where = f"{who}, frame {view.index}"
    require(view.T_map_base is None, where, "is placed in a map", "leave T_map_base to mapping")
    if view.color is not None:
        require(view.color.dtype == np.uint8, where, "color is not uint8", "give RGB, 0..255")
    if view.depth_m is not None:
        seen = view.depth_m[view.depth_m > 0]
        finite = bool(np.isfinite(view.depth_m).all()) and not (view.depth_m < 0).any()
        require(finite, where, "depth is negative or not finite", "put 0 where nothing came back")
        metres = float(np.median(seen)) < _FARTHEST_M
        require(metres, where, f"median depth is {np.median(seen):.0f} m", "convert it to metres")
    if view.scan is not None:
        require(
            bool(view.scan.hit.any()), where, "no laser beam came back", "check range_min and _max"
        )


def _check_slices(source: Source, first: Sequence[View | SkippedFrame], who: str) -> None:
    if len(first) < 2:
        return
    part = list(source.views(start=1, stop=len(first), stride=2))
    require(
        same(part, list(first[1::2])),
        who,
        f"views(start=1, stop={len(first)}, stride=2) gives other frames",
        "keep each frame's index and content whatever is skipped",
    )
