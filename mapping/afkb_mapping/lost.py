"""A lost robot: its views are skipped until some of them together fit one place of its map."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View
from afkb_mapping.placing_record import PlacingRecord
from afkb_mapping.relocation import FOUND_OVERLAP, LEAST_POINTS, relocated
from afkb_mapping.scan_matching import LocalMap, Match
from afkb_mapping.scan_surface import SurfacePoints, joined
from afkb_mapping.surface_map import SurfaceMap, thinned
from afkb_mapping.view_matching import best_match
from afkb_mapping.view_surface import ViewSurface

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


@dataclass(slots=True, eq=False)
class Lost:
    """What the views since the robot was lost show, where odometry has them; false if it isn't."""

    _surfaces: list[tuple[bool, SurfacePoints]] = field(default_factory=list)
    _count: int = 0

    def __bool__(self) -> bool:
        return self._count > 0

    def check(self, view: View) -> None:
        """Raise `BadFrame` for a view that shows nothing, if the robot is lost."""
        if self:
            raise BadFrame(WHY)

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
        self._count += 1
        self._surfaces = [*self._surfaces[1 - MOST_VIEWS :], (seen.by_laser, seen.surest)]
        alike = [surface for by_laser, surface in self._surfaces if by_laser == seen.by_laser]
        match = None
        if len(alike) >= LEAST_VIEWS:
            together, pivot_xy = thinned(joined(alike)), T_predicted[:2, 3]
            match = _near_odometry(together, pivot_xy, prior, surface_map)
            if match is None and (self._count <= PATIENCE or self._count % MOST_VIEWS == 0):
                match = relocated(together, pivot_xy, surface_map)
        if match is None:
            record.lose(view.index)
            raise BadFrame(WHY)
        shift, turn = np.hypot(*match.motion[:2]), np.degrees(match.motion[2])
        self.end(view, record, float(shift), float(turn))
        return match

    def end(
        self, view: View, record: PlacingRecord, metres: float = 0.0, degrees: float = 0.0
    ) -> None:
        """The robot is known to be so far from where odometry has it."""
        record.find(view.index, metres, degrees)
        self._surfaces, self._count = [], 0


def _near_odometry(
    seen: SurfacePoints, pivot_xy: Array, prior: Array, surface_map: SurfaceMap
) -> Match | None:
    """Where views fit near odometry's place after all: it was hidden by what has changed."""
    if len(seen) < LEAST_POINTS:
        return None
    local_map = LocalMap(surface_map.near(pivot_xy, NEAR_M))
    match = best_match(seen.near(pivot_xy, NEAR_M), local_map, pivot_xy, prior)
    return match if match is not None and match.overlap >= FOUND_OVERLAP else None
