"""From where things were looked at: the same look twice is no further evidence."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

DISTINCT_STEP_M = 0.25
DISTINCT_BEARING = math.radians(10)
"""Looks from closer together than both of these are one piece of evidence, not two."""


@dataclass(slots=True, eq=False)
class Viewpoints:
    """From where a thing was looked at; tells new viewpoints from repeated ones."""

    seen_from: list[tuple[float, float]] = field(default_factory=list)

    def is_new(self, camera_xy: NDArray[np.float64], thing_xy: NDArray[np.float64]) -> bool:
        """Whether a look from here is independent of the earlier ones; remembers it if so."""
        for other in self.seen_from:
            step = float(np.hypot(*(camera_xy - other)))
            if step < DISTINCT_STEP_M and _angle_between(camera_xy, other, thing_xy) < (
                DISTINCT_BEARING
            ):
                return False
        self.seen_from.append((float(camera_xy[0]), float(camera_xy[1])))
        return True


def _angle_between(
    a: NDArray[np.float64], b: tuple[float, float], apex: NDArray[np.float64]
) -> float:
    to_a, to_b = a - apex, np.asarray(b) - apex
    cross = to_a[0] * to_b[1] - to_a[1] * to_b[0]
    return abs(math.atan2(float(cross), float(to_a @ to_b)))
