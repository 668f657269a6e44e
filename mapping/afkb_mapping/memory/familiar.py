"""Which views show a viewpoint that is remembered well enough already."""

from __future__ import annotations

import math
from collections import defaultdict

from afkb.flow import View
from afkb_mapping.geometry import yaw_of
from afkb_mapping.things.viewpoints import DISTINCT_BEARING, DISTINCT_STEP_M

ENOUGH_LOOKS = 16
"""So many looks average a sensor's noise to a quarter. Of further ones each is kept whose number is
a power of two, so that a robot that stands and watches still sees what changes before it, and an
hour of standing costs eight looks more."""

Viewpoint = tuple[int, int, int]


class FamiliarViewpoints:
    """Counts looks from the same place in the same direction, so that memory is bounded by both.

    Nearer together than these no two looks are evidence of their own (see `Viewpoints`).
    """

    def __init__(self) -> None:
        self._looks: defaultdict[Viewpoint, int] = defaultdict(int)

    def is_worth_keeping(self, view: View) -> bool:
        """Whether a placed view, which is counted by this, shows its viewpoint anew."""
        viewpoint = _viewpoint(view)
        self._looks[viewpoint] += 1
        looks = self._looks[viewpoint]
        return looks <= ENOUGH_LOOKS or looks & (looks - 1) == 0


def _viewpoint(view: View) -> Viewpoint:
    T = view.T_map_camera if view.T_base_camera is not None else view.T_map_laser
    heading = yaw_of(T) if view.T_base_camera is None else math.atan2(T[1, 2], T[0, 2])
    return (
        math.floor(T[0, 3] / DISTINCT_STEP_M),
        math.floor(T[1, 3] / DISTINCT_STEP_M),
        math.floor(heading / DISTINCT_BEARING),
    )
