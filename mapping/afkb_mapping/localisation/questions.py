"""Views of a recording as questions to a map: where the robot was when it saw them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb_mapping.localisation.bands import STATE_FILE, HeightBands
from afkb_mapping.localisation.localiser import Localiser, Located
from afkb_mapping.localisation.readings import Readings, readings_of
from afkb_mapping.placing.levelling import level
from afkb_mapping.selection import FrameRange, Selection


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """Where the base stood at the last view of a question; `stamp` of that view, s."""

    stamp: float
    located: Located


def localiser_of(folder: Path) -> Localiser:
    """A localiser in a stored map.

    Raises `MapError` where the folder holds no map, or one without height bands.
    """
    if not folder.is_dir():
        raise MapError(f"{folder}: no such map; `afkb map SOURCE --out {folder}` writes one")
    path = folder / "state" / STATE_FILE
    if not path.is_file():
        raise MapError(f"{folder}: has no state/{STATE_FILE} to locate views in; map again")
    return Localiser(HeightBands.from_bytes(path.read_bytes()))


def answers(
    localiser: Localiser, source: Source, frames: FrameRange, views: int = 1
) -> Iterator[Answer | SkippedFrame]:
    """Where the robot was, asked with so many consecutive views at a time.

    Between the views of one question odometry is trusted; between questions nothing is known.
    Raises `SourceError` where no frame can be used.
    """
    selection = Selection(source, frames)
    T_level_source = level(selection.sample(), source.gravity_aligned).T_map_source
    together: list[View] = []
    for frame in selection.frames():
        if isinstance(frame, SkippedFrame):
            yield frame
            continue
        together.append(frame)
        if len(together) == views:
            yield Answer(frame.stamp, localiser.locate(asked(together, T_level_source)))
            together = []


def asked(views: Sequence[View], T_level_source: NDArray[np.float64]) -> list[Readings]:
    """What each of some views reads, in the frame of the last one's base by odometry.

    `T_level_source` (4, 4): from the frame of their odometry to a level one on the floor.
    """
    bases = [T_level_source @ view.T_odom_base for view in views]
    to_last = np.linalg.inv(bases[-1])
    return [
        readings_of(view, base).seen_from(to_last @ base)
        for view, base in zip(views, bases, strict=True)
    ]
