"""Views of a recording at their places in the map: gated, levelled, registered."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import SkippedFrame, View
from afkb_mapping.placing.held_views import HeldViews
from afkb_mapping.placing.pose_gate import PoseGate
from afkb_mapping.placing.record import PlacingRecord
from afkb_mapping.placing.registration import ScanRegistration
from afkb_mapping.run_record import Stages
from afkb_mapping.selection import Selection

TAKEN_BACK = "taken back: the views that follow contradict the map where odometry has them"


def placed_views(
    selection: Selection,
    T_map_source: NDArray[np.float64],
    stages: Stages,
    known: Iterable[View] = (),
    record: PlacingRecord | None = None,
) -> Iterator[View | SkippedFrame]:
    """Every frame of a selection, placed in the map frame, or why it can't be.

    In order, but some late: a view that only its image placed waits until its place is sure.

    `known`: placed views of earlier visits, which the first ones are registered to. `record` is
    told where the robot was lost.
    """
    record = record or PlacingRecord()
    registration, gate = ScanRegistration(T_map_source, record), PoseGate()
    with stages.timed("register"):
        for view in known:
            registration.recall(view)
    waiting: deque[View | SkippedFrame] = deque()
    for frame in _read(selection, stages):
        if isinstance(frame, View):
            record.gaps.see(frame.stamp, frame.index)
        with stages.timed("register"):
            waiting.append(_placed(frame, registration, gate))
        yield from _decided(waiting, registration.held)
    registration.end()
    record.end()
    yield from _decided(waiting, registration.held)


def _placed(
    frame: View | SkippedFrame, registration: ScanRegistration, gate: PoseGate
) -> View | SkippedFrame:
    if isinstance(frame, SkippedFrame):
        return frame
    try:
        gate.check(frame)
        return replace(frame, T_map_base=registration.place(frame).T_map_base)
    except BadFrame as error:
        return skipped(frame, error)


def _decided(waiting: deque[View | SkippedFrame], held: HeldViews) -> Iterator[View | SkippedFrame]:
    """The first ones that wait for nothing more, in order; those taken back have no place."""
    while waiting and waiting[0].index not in held:
        frame = waiting.popleft()
        if isinstance(frame, View) and frame.index in held.withdrawn:
            yield skipped(frame, BadFrame(TAKEN_BACK))
        else:
            yield frame


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
