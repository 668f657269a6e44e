"""Looks at what is known: what they tell of things that no detector spoke of in a view."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from afkb.flow import ChangeKind, View
from afkb.inference.existence import EMPTY_LIKELIHOOD_RATIO, OVERLOOKED_LIKELIHOOD_RATIO
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.things.visibility import Look, Sight
from afkb_mapping.visits.persistence import (
    HOUR_S,
    aged,
)

LOOKED_AT_SHARE = 0.7
"""A look tells of a thing if so much of it is in view, and tells one thing of so much of that."""


def eye_of(view: View) -> NDArray[np.float64]:
    """(2,) m, map frame: from where a placed view looks."""
    T = view.T_map_camera if view.depth_m is not None else view.T_map_laser
    eye: NDArray[np.float64] = T[:2, 3]
    return eye


def is_empty(found: Look) -> bool:
    """Whether a look saw through where a thing should be."""
    return found.in_view >= LOOKED_AT_SHARE and found.empty >= LOOKED_AT_SHARE


def look_at(track: ObservedTrack, sight: Sight, eye: NDArray[np.float64], view: View) -> None:
    """Take in that a view did not detect a thing: what is seen through counts against it.

    The paper has no such term.
    """
    body = track.footprint.points()
    found = sight.look(body, track.look_height_m)
    if is_empty(found) and track.empty_from.is_new(eye, body[0]):
        kind, ratio = ChangeKind.SEEN_THROUGH, EMPTY_LIKELIHOOD_RATIO
        track.life.take(kind, ratio, view.stamp, view.index)
    elif _is_overlooked(track, found, eye) and track.missed_from.is_new(eye, body[0]):
        kind, ratio = ChangeKind.OVERLOOKED, OVERLOOKED_LIKELIHOOD_RATIO
        track.life.take(kind, ratio, view.stamp, view.index)


def age(
    tracks: Iterable[ObservedTrack],
    seconds: float,
    stamp: float,
    hazard: Callable[[ObservedTrack], float],
) -> None:
    """Let time pass over things up to a stamp: they may have been moved, and looks tell anew."""
    for track in tracks:
        if track.is_floor:
            continue
        track.life.take(ChangeKind.AGED, aged(1.0, seconds, hazard(track)), stamp)
        if seconds >= HOUR_S:
            track.forget_looks()


def _is_overlooked(track: ObservedTrack, found: Look, eye: NDArray[np.float64]) -> bool:
    """Whether a thing is in clear view, as near as it was ever seen from, and not detected."""
    if track.is_surface or found.in_view < 1.0 or found.hit < LOOKED_AT_SHARE:
        return False
    nearest = np.linalg.norm(track.footprint.points() - eye, axis=1).min()
    return bool(nearest <= track.farthest_m)
