"""What stands around a station, put together from the stations before and after it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.loops.landmarks import Landmarks, joined
from afkb_mapping.loops.stations import Station
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.scan_surface import joined as joined_surfaces

Array = NDArray[np.float64]

AROUND = 3
"""So many stations before and after one help to tell what is around it,"""
AROUND_M = 2.0
"""if they are as near as this."""


def neighbours(poses: Sequence[Array], k: int) -> list[int]:
    """Indexes of the stations around the k-th, itself among them."""
    near = range(max(0, k - AROUND), min(len(poses), k + AROUND + 1))
    return [j for j in near if np.hypot(*(poses[j][:2, 3] - poses[k][:2, 3])) <= AROUND_M]


def surface_around(
    stations: Sequence[Station], poses: Sequence[Array], k: int, of: Iterable[int] | None = None
) -> SurfacePoints:
    """Surface seen from the stations around the k-th (or from some), in its base frame."""
    back = np.linalg.inv(poses[k])
    parts = []
    for j in neighbours(poses, k) if of is None else of:
        T = back @ poses[j]
        parts.append(stations[j].surface.moved(T[:2, :2], T[:2, 3]))
    return joined_surfaces(parts)


def landmarks_around(stations: Sequence[Station], poses: Sequence[Array], k: int) -> Landmarks:
    """Landmarks seen from the stations around the k-th, in its base frame; each thing once."""
    back = np.linalg.inv(poses[k])
    parts = [stations[j].landmarks.seen_from(back @ poses[j]) for j in neighbours(poses, k)]
    seen = joined(parts)
    return seen[seen.distinct()]
