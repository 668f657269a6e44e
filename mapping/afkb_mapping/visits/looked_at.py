"""What a visit's views tell of places where something was at another visit: there, gone, unseen."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.entities import EXISTS_FROM
from afkb_mapping.looks import LOOKED_AT_SHARE, eye_of, is_empty
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.viewpoints import Viewpoints
from afkb_mapping.visibility import Look, Sight
from afkb_mapping.visits.persistence import aged, hazard_of, overlooked, seen_through
from afkb_mapping.visits.things import ComparedThing

Array = NDArray[np.float64]

NEAR_M = 2.5
"""A small thing that no detector spoke of was looked at from no further than this: of further ones
detectors miss most."""


class Verdict(Enum):
    """What looks at a place tell of a thing that was there at another visit."""

    THERE = "there"
    GONE = "gone"
    UNKNOWN = "unknown"


@dataclass(slots=True, eq=False)
class _Place:
    """A thing's place, and what looks at it from different viewpoints have told so far."""

    points_xy: Array
    height_m: float
    is_surface: bool
    existence: float
    viewpoints: Viewpoints
    met: int = 0
    looks: int = 0

    def look(self, found: Look, eye_xy: Array) -> None:
        """Take in one view's look; from where it was looked at before it tells nothing new."""
        middle = self.points_xy.mean(axis=0)
        empty, met = is_empty(found), found.in_view >= LOOKED_AT_SHARE <= found.hit
        if not self.is_surface and np.linalg.norm(eye_xy - middle) > NEAR_M:
            met = False
        if not (empty or met) or not self.viewpoints.is_new(eye_xy, middle):
            return
        self.looks += 1
        if empty:
            self.existence = seen_through(self.existence)
        elif self.is_surface:
            self.met += 1
        else:  # Something is there; as it was not told of, it is hardly what was there.
            self.existence = overlooked(self.existence)

    def verdict(self) -> Verdict:
        """A surface is there where depth meets it more often than it is seen through."""
        if self.met and self.met >= self.looks - self.met:
            return Verdict.THERE
        if self.looks and self.existence < EXISTS_FROM:
            return Verdict.GONE
        return Verdict.UNKNOWN


def verdicts(
    things: Sequence[ComparedThing],
    views: Iterable[RememberedView],
    T_things_views: Array,
    seconds: float,
) -> list[Verdict]:
    """Of things that another visit has seen, and this one did not detect in their places.

    - `views`: of this visit; `T_things_views` (4, 4): from their map frame to that of the things.
    - `seconds`: from one visit to the other.
    """
    places = [
        _Place(
            points_xy=thing.points_xy(),
            height_m=thing.xyz[2],
            is_surface=thing.is_surface,
            existence=aged(thing.existence, abs(seconds), hazard_of(thing.weight)),
            viewpoints=Viewpoints(),
        )
        for thing in things
    ]
    for remembered in views:
        view = remembered.moved_to(T_things_views @ remembered.T_map_base).view
        sight, eye = Sight(view), eye_of(view)
        for place in places:
            place.look(sight.look(place.points_xy, place.height_m), eye)
    return [place.verdict() for place in places]
