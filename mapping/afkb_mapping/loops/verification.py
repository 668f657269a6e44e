"""Whether walls and free space bear out that two stations see one place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import transform_xy
from afkb_mapping.loops.stations import Station
from afkb_mapping.loops.steps import (
    DEPTH_SIGMAS,
    LASER_SIGMAS,
    LEAST_POINTS,
    Constraint,
    laid_on,
)
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.seen_through import compared

Array = NDArray[np.float64]

LEAST_OVERLAP = 0.5
"""Share of what is seen from one station that must stand where the other has seen something."""
MOST_SEEN_THROUGH = 0.25
"""Share of the one's surface, in view of the other, that the other may see through: of what moved.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """What geometry says: the constraint, made exact, or None and the `reason`."""

    constraint: Constraint | None
    reason: str
    overlap: float = 0.0


def verified(
    onto: SurfacePoints, station: Station, seen: SurfacePoints, T_start: Array, by_laser: bool
) -> Verdict:
    """Lay what is `seen` about a station on a surface, from a start (4, 4) on, and judge the fit.

    Both in base frames; `seen` holds the station's own surface and what its neighbours add.
    `by_laser`: whether both are single scans of a laser, which fit to its own noise.
    """
    if len(seen) < LEAST_POINTS or len(onto) < LEAST_POINTS:
        return Verdict(None, "no walls or furniture in sight to verify it by")
    sigmas = LASER_SIGMAS if by_laser else DEPTH_SIGMAS
    laid = laid_on(seen, onto, T_start, LEAST_OVERLAP, sigmas)
    if laid is None:
        return Verdict(None, "walls and furniture do not fit")
    constraint, overlap = laid
    T = constraint.T_a_b
    own = station.surface.moved(T[:2, :2], T[:2, 3])
    through = compared(own, onto, transform_xy(T, station.eye_xy[None])[0]).through_share
    if through > MOST_SEEN_THROUGH:
        return Verdict(None, f"{through:.0%} of what stands there is seen through", overlap)
    return Verdict(constraint, "", overlap)
