"""Views whose places are not sure yet: they are told only when nothing more speaks against them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.geometry import inverse, yaw_of
from afkb_mapping.placing.view_surface import ViewSurface

Array = NDArray[np.float64]

ANOTHER_LOOK_M, ANOTHER_LOOK_RAD = 0.2, math.radians(10)
"""A camera that moved less than both sees the same again, which makes nothing surer."""
HELD_LOOKS = 6
"""A robot that was carried off contradicts its map within so many looks, or shows new ground."""
MOST_HELD = 30
"""No more views than this wait, however little the robot moves."""


@dataclass(frozen=True, slots=True, eq=False)
class HeldView:
    """A placed view that may have to be taken back: what it showed, as it was placed."""

    index: int
    seen: ViewSurface
    is_another_look: bool


@dataclass(slots=True, eq=False)
class HeldViews:
    """The last placed views, oldest first; `withdrawn`: indices of those that were taken back.

    `settled`: how many have been let go.
    """

    withdrawn: set[int] = field(default_factory=set)
    settled: int = 0
    _views: list[HeldView] = field(default_factory=list)
    _T_last_look: Array | None = None

    def __contains__(self, index: int) -> bool:
        return any(held.index == index for held in self._views)

    def hold(self, view: View, seen: ViewSurface) -> None:
        """One more; the oldest are let go when enough looks followed them."""
        is_new = self._T_last_look is None or is_another_look(self._T_last_look, view.T_odom_base)
        if is_new:
            self._T_last_look = view.T_odom_base
        self._views.append(HeldView(view.index, seen, is_new))
        while sum(v.is_another_look for v in self._views) > HELD_LOOKS or self._are_too_many:
            del self._views[0]
            self.settled += 1

    def release(self) -> list[HeldView]:
        """All of them: their places are sure."""
        released, self._views = self._views, []
        self.settled += len(released)
        return released

    def withdraw(self) -> list[HeldView]:
        """All of them: they were not taken where they were placed."""
        taken_back, self._views = self._views, []
        self.withdrawn |= {held.index for held in taken_back}
        return taken_back

    @property
    def _are_too_many(self) -> bool:
        return len(self._views) > MOST_HELD


def is_another_look(T_before: Array, T_after: Array) -> bool:
    """Whether a camera moved enough between two poses (4, 4) to see something else."""
    T_step = inverse(T_before) @ T_after
    shift, turn = float(np.linalg.norm(T_step[:3, 3])), abs(yaw_of(T_step))
    return shift > ANOTHER_LOOK_M or turn > ANOTHER_LOOK_RAD
