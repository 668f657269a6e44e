"""Whether two observations may be of one thing: by outline, height and length."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.things.tracks import THING_CELL_M, ObservedTrack

SURFACE_OVERLAP = 0.05
"""Two views of one surface share at least this part of the smaller one's cells; neighbouring
pieces of furniture share none, however small the gap."""
SURFACE_GAP_M = 0.08
"""Where the image edge cuts a surface, its other part may begin this far on."""
SURFACE_HEIGHT_M = 0.015
"""Parts of one surface agree in height within this and the measurement's standard deviation."""
SOFT_HEIGHT_M, SOFT_OVERLAP = 0.06, 0.5
"""Nothing supports right under another surface: what lies on top of each other, this near, is one
soft or hollow seat, or a tray on its table."""
THING_REACH_M = 0.06
THING_HEIGHT_M = 0.06
SAME_EXTENT = 2.5
"""One view of a thing shows at most so many times the length that another shows: more is something
that it stands on or beside."""
FOOTPRINT_SPACING_M = 0.02
"""How far apart a detection's footprint points lie, by its contract."""
FAR_M = 1e3


def is_surface(detection: Detection) -> bool:
    """Whether supporting is what it is detected by; a box affords it too, but is a thing."""
    first = (detection.parts or (detection,))[0]
    best = max(first.affordances, key=lambda name: first.affordances[name])
    return best == "SupportAbility"


def is_floor(detection: Detection) -> bool:
    """Whether its detector holds it for the floor."""
    return bool(detection.measures.get("is_floor", 0.0))


def same_height(track: ObservedTrack, detection: Detection) -> bool:
    """Whether a surface may be a part of a known one, by height."""
    deviation = float(np.sqrt(max(detection.covariance_xyz[2, 2], 0.0)))
    apart = abs(track.top.value - detection.position_xyz[2])
    return bool(apart <= SURFACE_HEIGHT_M + deviation)


def continues(track: ObservedTrack, detection: Detection) -> bool:
    """Whether a surface that the image edge cuts goes on where the track is."""
    return detection.cut_by_image and (
        track.footprint.share_within(detection.footprint_xy, SURFACE_GAP_M) > 0
    )


def same_surface(first: ObservedTrack, second: ObservedTrack) -> bool:
    """Whether two tracks have grown into the same surface."""
    if first.is_floor or second.is_floor:
        return False
    apart = abs(first.top.value - second.top.value)
    if apart > SOFT_HEIGHT_M:
        return False
    wanted = SURFACE_OVERLAP if apart <= SURFACE_HEIGHT_M else SOFT_OVERLAP
    return first.footprint.overlap(second.footprint.points()) >= wanted


def _overlap_in_height(track: ObservedTrack, bottom: float, top: float) -> bool:
    ends_agree = (
        abs(track.top.value - top) < THING_HEIGHT_M
        or abs(track.bottom.value - bottom) < THING_HEIGHT_M
    )
    return (
        ends_agree
        and min(track.top.value, top) > max(track.bottom.value, bottom) - THING_HEIGHT_M / 2
    )


def distances(
    tracks: Sequence[ObservedTrack], middles: NDArray[np.float64], detection: Detection
) -> NDArray[np.float64]:
    """Distance (m) of each track's middle (N, 2) if both may be one thing, else FAR_M: (N,)."""
    box = detection.box
    apart = np.hypot(*(middles - np.asarray(box.center_xyz[:2])).T)
    found = np.full(len(tracks), FAR_M)
    for i in np.flatnonzero(apart <= gate(detection)).tolist():
        if not _as_long(tracks[i], detection):
            continue
        if _overlap_in_height(tracks[i], box.bottom, box.top):
            shared = tracks[i].footprint.share_within(detection.footprint_xy, THING_CELL_M)
            found[i] = apart[i] * (1.5 - shared)
    return found


def gate(detection: Detection) -> float:
    """How far the middle of a thing may be from a detection of it, m.

    Two solid things can't come nearer to each other than their width.
    """
    width = sum(detection.box.size_xyz[:2]) / 2
    return max(THING_REACH_M, width) + 2 * float(np.sqrt(detection.covariance_xyz[0, 0]))


def around(
    points_xy: NDArray[np.float64], reach_m: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower left and upper right corner of the box around points (N, 2) and a reach about them."""
    return points_xy.min(axis=0) - reach_m, points_xy.max(axis=0) + reach_m


def _as_long(track: ObservedTrack, detection: Detection) -> bool:
    """Whether both may be the length of one thing, as far as views of a part allow."""
    low, high = track.footprint.box()
    known, seen = float(np.hypot(*(high - low))), float(np.hypot(*detection.box.size_xyz[:2]))
    shorter, longer = sorted((known + THING_REACH_M, seen + THING_REACH_M))
    return longer <= SAME_EXTENT * shorter


def may_touch(first: ObservedTrack, second: ObservedTrack) -> bool:
    """Whether the boxes around two footprints come as near as one thing's parts may."""
    (low, high), (other_low, other_high) = first.footprint.box(), second.footprint.box()
    return all(
        low[k] <= other_high[k] + THING_REACH_M and other_low[k] <= high[k] + THING_REACH_M
        for k in range(2)
    )


def same_thing(first: ObservedTrack, second: ObservedTrack) -> bool:
    """Whether two tracks have grown into the place of one thing."""
    if not _overlap_in_height(first, second.bottom.value, second.top.value):
        return False
    shared = max(
        first.footprint.share_within(second.footprint.points(), FOOTPRINT_SPACING_M),
        second.footprint.share_within(first.footprint.points(), FOOTPRINT_SPACING_M),
    )
    return shared > 0.5
