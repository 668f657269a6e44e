"""What may befall a recording: odometry that jumps, a robot that is carried, blind lasers, ..."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import count

import numpy as np
from numpy.typing import NDArray

from afkb.flow import SkippedFrame, View
from afkb_mapping.geometry import T_from_xy_yaw
from bench.mapping.altered import Alter, Frames

JUMP_M = 2.0
BLIND_SCANS = 100
LOST_FRAMES = 0.3
CARRIED_VIEWS = 25
"""So many views of the tour are missing while it is carried; odometry says it stood still."""
SEED = 1


def odometry_jumps(at: float) -> Alter:
    """From this part of the tour on, odometry is off by `JUMP_M` more."""

    def alter(frames: Frames) -> Frames:
        taken = list(frames)
        first = int(at * len(taken))
        yield from taken[:first]
        T_jump = T_from_xy_yaw(JUMP_M, 0.0, 0.0)
        for frame in taken[first:]:
            if isinstance(frame, View):
                frame = _with_odometry(frame, T_jump @ frame.T_odom_base)
            yield frame

    return alter


def kidnapped(at: float) -> Alter:
    """Carried to where it was `CARRIED_VIEWS` later; odometry goes on as if nothing happened."""

    def alter(frames: Frames) -> Frames:
        taken = [f for f in frames if isinstance(f, View)]
        first = int(at * len(taken))
        yield from taken[:first]
        there = taken[first + CARRIED_VIEWS :]
        T_here_there = taken[first - 1].T_odom_base @ np.linalg.inv(there[0].T_odom_base)
        for view in there:
            yield _with_odometry(view, T_here_there @ view.T_odom_base)

    return alter


def carried_back(at: float) -> Alter:
    """Carried back to the tour's start, which it then makes again; odometry knows nothing of it."""

    def alter(frames: Frames) -> Frames:
        taken = [f for f in frames if isinstance(f, View)]
        first = int(at * len(taken))
        return joined_recordings(taken[:first], taken[: first // 2])

    return alter


def laser_blind(at: float) -> Alter:
    """For `BLIND_SCANS` scans nothing comes back to the laser."""

    def alter(frames: Frames) -> Frames:
        taken = list(frames)
        first = int(at * len(taken))
        for n, frame in enumerate(taken):
            blind = first <= n < first + BLIND_SCANS and isinstance(frame, View) and frame.scan
            if blind and isinstance(frame, View) and frame.scan is not None:
                nothing = np.full_like(frame.scan.ranges_m, np.inf)
                frame = replace(frame, scan=replace(frame.scan, ranges_m=nothing))
            yield frame

    return alter


def frames_lost(frames: Frames) -> Frames:
    """A share of the frames never came."""
    rng = np.random.default_rng(SEED)
    return (frame for n, frame in enumerate(frames) if rng.random() >= LOST_FRAMES or n == 0)


def followed_by(other: Sequence[View | SkippedFrame]) -> Alter:
    """Another recording follows in the same file; its odometry starts where this one's did."""

    def alter(frames: Frames) -> Frames:
        return joined_recordings([f for f in frames if isinstance(f, View)], other)

    return alter


def joined_recordings(first: Sequence[View], then: Sequence[View | SkippedFrame]) -> Frames:
    """One recording after the other: time goes on, and odometry from where it was at first."""
    views = [f for f in then if isinstance(f, View)]
    step = float(np.median(np.diff([v.stamp for v in first])))
    T_end_begin = first[-1].T_odom_base @ np.linalg.inv(views[0].T_odom_base)
    yield from first
    for n, view in zip(count(1), views, strict=False):
        moved = _with_odometry(view, T_end_begin @ view.T_odom_base)
        yield replace(moved, stamp=first[-1].stamp + n * step)


def _with_odometry(view: View, T_odom_base: NDArray[np.float64]) -> View:
    return replace(view, T_odom_base=T_odom_base)
