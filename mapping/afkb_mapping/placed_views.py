"""Views of a recording at their places in the map: gated, levelled, registered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import SkippedFrame, View
from afkb_mapping.placing_record import PlacingRecord
from afkb_mapping.pose_gate import PoseGate
from afkb_mapping.registration import ScanRegistration
from afkb_mapping.run_record import Stages
from afkb_mapping.selection import Selection


def placed_views(
    selection: Selection,
    T_map_source: NDArray[np.float64],
    stages: Stages,
    known: Iterable[View] = (),
    record: PlacingRecord | None = None,
) -> Iterator[View | SkippedFrame]:
    """Every frame of a selection, placed in the map frame, or why it can't be.

    `known`: placed views of earlier visits, which the first ones are registered to. `record` is
    told where the robot was lost.
    """
    registration, gate = ScanRegistration(T_map_source, record), PoseGate()
    with stages.timed("register"):
        for view in known:
            registration.recall(view)
    for frame in _read(selection, stages):
        if isinstance(frame, SkippedFrame):
            yield frame
            continue
        try:
            gate.check(frame)
            with stages.timed("register"):
                placed = replace(frame, T_map_base=registration.place(frame).T_map_base)
        except BadFrame as error:
            yield skipped(frame, error)
            continue
        yield placed


def skipped(view: View, error: BadFrame) -> SkippedFrame:
    """The record of a view that could not be used."""
    return SkippedFrame(view.index, f"frame {view.index}", str(error))


def _read(selection: Selection, stages: Stages) -> Iterator[View | SkippedFrame]:
    frames = selection.frames()
    while True:
        with stages.timed("read"):
            frame = next(frames, None)
        if frame is None:
            return
        yield frame
