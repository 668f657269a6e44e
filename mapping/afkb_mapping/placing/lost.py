"""A lost robot: its views are skipped until some of them together fit one place of its map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View
from afkb_mapping.placing.held_views import is_another_look
from afkb_mapping.placing.record import PlacingRecord
from afkb_mapping.placing.relocation import (
    FOUND_OVERLAP,
    FOUND_OVERLAP_BY_IMAGE,
    LEAST_POINTS,
    relocated,
)
from afkb_mapping.placing.scan_matching import LocalMap, Match, rotation
from afkb_mapping.placing.scan_surface import SurfacePoints, joined
from afkb_mapping.placing.seen_through import compared
from afkb_mapping.placing.surface_map import SurfaceMap, thinned
from afkb_mapping.placing.view_matching import MAX_DEVIATION, best_match, deviation
from afkb_mapping.placing.view_surface import ViewSurface

Array = NDArray[np.float64]

LEAST_VIEWS = 2
"""One view may look like somewhere else by chance."""
MOST_VIEWS = 6
"""So many of the last views are looked for together: a half turn of a camera; odometry is trusted
between them."""
PATIENCE = 12
"""After so many lost views only every `MOST_VIEWS`-th is looked for: most likely this is a place
that the map does not hold."""
NEAR_M = 6.0
"""How far around views are compared near odometry's place."""
WHY = "lost: it looks through what is mapped where odometry has it, and fits nowhere else for sure"


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """What a view showed, where odometry has it, and from where (2,)."""

    by_laser: bool
    surface: SurfacePoints
    from_xy: Array


@dataclass(slots=True, eq=False)
class Lost:
    """What the views since the robot was lost show, where odometry has them; false if it isn't."""

    _looks: list[Look] = field(default_factory=list)
    _count: int = 0
    _T_odom_base: Array | None = None

    def __bool__(self) -> bool:
        return self._count > 0

    def look(
        self,
        view: View,
        seen: ViewSurface,
        T_predicted: Array,
        prior: Array,
        surface_map: SurfaceMap,
        record: PlacingRecord,
    ) -> Match:
        """The motion about the predicted place that puts the view where it was taken.

        `prior`: (3, 3), covariance of odometry since the last view that had a place. Raises
        `BadFrame` while that is unsure.
        """
        match = None
        if self._is_news(view, seen):
            self._count += 1
            self._T_odom_base = view.T_odom_base
            look = Look(seen.by_laser, seen.surest, T_predicted[:2, 3].copy())
            self._looks = [*self._looks[1 - MOST_VIEWS :], look]
            match = self._found(seen.by_laser, T_predicted[:2, 3], prior, surface_map)
        if match is None:
            record.lose(view.index)
            raise BadFrame(WHY)
        return match

    def _is_news(self, view: View, seen: ViewSurface) -> bool:
        """Whether it shows more than the look before; a scan may, as a laser sweeps."""
        T = self._T_odom_base
        return T is None or seen.by_laser or is_another_look(T, view.T_odom_base)

    def _found(
        self, by_laser: bool, pivot_xy: Array, prior: Array, surface_map: SurfaceMap
    ) -> Match | None:
        alike = [look for look in self._looks if look.by_laser == by_laser]
        if len(alike) < LEAST_VIEWS or (self._count > PATIENCE and self._count % MOST_VIEWS):
            return None
        together = thinned(joined([look.surface for look in alike]))
        match = _near_odometry(together, pivot_xy, prior, surface_map)
        if match is None:
            least = FOUND_OVERLAP if by_laser else FOUND_OVERLAP_BY_IMAGE
            match = relocated(together, pivot_xy, surface_map, least)
        if match is None or _is_refuted(match, alike, pivot_xy, surface_map):
            return None
        return match

    def end(self) -> None:
        """The robot is found."""
        self._looks, self._count, self._T_odom_base = [], 0, None


def _is_refuted(
    match: Match, looks: Sequence[Look], pivot_xy: Array, surface_map: SurfaceMap
) -> bool:
    """Whether any of the looks contradicts the map, were the robot found there."""
    R = rotation(float(match.motion[2]))
    for look in looks:
        from_xy = pivot_xy + match.motion[:2] + R @ (look.from_xy - pivot_xy)
        placed = look.surface.moved(R, pivot_xy + match.motion[:2] - R @ pivot_xy)
        local_map = LocalMap(surface_map.near(from_xy, NEAR_M))
        if compared(placed, local_map.surface, from_xy).disagrees:
            return True
    return False


def _near_odometry(
    seen: SurfacePoints, pivot_xy: Array, prior: Array, surface_map: SurfaceMap
) -> Match | None:
    """Where views fit near odometry's place after all: it was hidden by what has changed."""
    if len(seen) < LEAST_POINTS:
        return None
    local_map = LocalMap(surface_map.near(pivot_xy, NEAR_M))
    match = best_match(seen.near(pivot_xy, NEAR_M), local_map, pivot_xy, prior)
    if match is None or match.overlap < FOUND_OVERLAP:
        return None
    return match if deviation(match, prior) <= MAX_DEVIATION else None
