"""What a visit's views tell of places where something was at another visit: there, gone, unseen."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.things.entities import EXISTS_FROM
from afkb_mapping.things.looks import LOOKED_AT_SHARE, eye_of
from afkb_mapping.things.viewpoints import Viewpoints
from afkb_mapping.things.visibility import Sight
from afkb_mapping.visits.body_points import look_at_body, may_show, placed
from afkb_mapping.visits.persistence import aged, hazard_of, met_again, overlooked, seen_through
from afkb_mapping.visits.things import ComparedThing

Array = NDArray[np.float64]

NEAR_M = 2.5
"""A small thing that no detector spoke of was looked at from no further than this: of further ones
detectors miss most."""
SEEN_THROUGH_SHARE = 0.5
"""A thing of which so much is seen through has gone, though the rest may be out of the image."""
TOLD_SHARE = 0.2
"""A look from one side meets, or sees through, so much at least of the points on all its sides."""


class Verdict(Enum):
    """What looks at a place tell of a thing that was there at another visit."""

    THERE = "there"
    GONE = "gone"
    UNKNOWN = "unknown"


@dataclass(slots=True, eq=False)
class _Place:
    """A thing's place, and what looks at it from different viewpoints have told so far.

    `body_xyz` (N, 3): points of it, if its own visit has measured any.
    """

    thing: ComparedThing
    body_xyz: Array
    existence: float
    points_xy: Array = field(init=False)
    viewpoints: Viewpoints = field(default_factory=Viewpoints)
    met: int = 0
    looks: int = 0

    def __post_init__(self) -> None:
        self.points_xy = self.thing.points_xy()

    def look(self, view: View, sight: Sight, eye_xy: Array) -> None:
        """Take in one view's look; from where it was looked at before it tells nothing new."""
        middle = self.points_xy.mean(axis=0)
        if len(self.body_xyz):
            found, share = look_at_body(view, self.body_xyz, self.thing.bottom_m), TOLD_SHARE
        else:
            found, share = sight.look(self.points_xy, self.thing.xyz[2]), LOOKED_AT_SHARE
        empty = found.in_view >= share and found.empty >= LOOKED_AT_SHARE
        empty |= found.in_view * found.empty >= SEEN_THROUGH_SHARE
        met = found.in_view >= share and found.hit >= LOOKED_AT_SHARE
        if not self._tells_if_met and np.linalg.norm(eye_xy - middle) > NEAR_M:
            met = False
        if not (empty or met) or not self.viewpoints.is_new(eye_xy, middle):
            return
        self.looks += 1
        self.met += met
        if empty:
            self.existence = seen_through(self.existence)
        elif len(self.body_xyz):
            self.existence = met_again(self.existence)
        elif not self._tells_if_met:  # Something is there, perhaps what it stood on.
            self.existence = overlooked(self.existence)

    @property
    def _tells_if_met(self) -> bool:
        """Whether depth that agrees tells that it is there: its shape is known."""
        return self.thing.is_surface or len(self.body_xyz) > 0

    def verdict(self) -> Verdict:
        """A surface is there where depth meets it more often than it is seen through."""
        is_there = self.met >= self.looks - self.met
        if not self.thing.is_surface:
            is_there = self._tells_if_met and self.existence >= EXISTS_FROM
        if self.met and is_there:
            return Verdict.THERE
        if self.looks and self.existence < EXISTS_FROM:
            return Verdict.GONE
        return Verdict.UNKNOWN


def verdicts(
    things: Sequence[ComparedThing],
    bodies: Sequence[Array],
    views: Iterable[RememberedView],
    T_things_views: Array,
    seconds: float,
) -> list[Verdict]:
    """Of things that another visit has seen, and this one did not detect in their places.

    - `bodies`: points (N, 3) of each, by `body_points`.
    - `views`: of this visit; `T_things_views` (4, 4): from their map frame to that of the things.
    - `seconds`: from one visit to the other.
    """
    places = [
        _Place(thing, body, aged(thing.existence, abs(seconds), hazard_of(thing.weight)))
        for thing, body in zip(things, bodies, strict=True)
    ]
    for view in placed(views, T_things_views):
        sight, eye = Sight(view), eye_of(view)
        for place in places:
            if may_show(view, place.thing):
                place.look(view, sight, eye)
    return [place.verdict() for place in places]
