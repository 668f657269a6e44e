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
        x, y = float(camera_xy[0]), float(camera_xy[1])
        thing_x, thing_y = float(thing_xy[0]), float(thing_xy[1])
        for other_x, other_y in self.seen_from:
            if math.hypot(x - other_x, y - other_y) >= DISTINCT_STEP_M:
                continue
            here, there = (x - thing_x, y - thing_y), (other_x - thing_x, other_y - thing_y)
            if _angle_between(here, there) < DISTINCT_BEARING:
                return False
        self.seen_from.append((x, y))
        return True


def _angle_between(a: tuple[float, float], b: tuple[float, float]) -> float:
    return abs(math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]))
