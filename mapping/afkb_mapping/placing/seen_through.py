"""Whether a view looks through what the map has: then it was not taken where odometry says."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.placing.scan_surface import SurfacePoints

Array = NDArray[np.float64]

BEARINGS = 360
"""Directions in which a view and the map are compared: a degree each."""
AGREE_M, AGREE_PER_M = 0.15, 0.05
"""Ranges that differ by less are of one surface: a turn of 3 degrees moves what is seen so far."""
FACING = 0.3
"""Sine of the least angle to a mapped surface; at less, a small turn changes its range by much."""
LEAST_COMPARED = 15
"""Fewer directions in which both show a surface tell nothing."""
LEAST_AGREEING = 0.5
"""Views that were taken where the map has them agree with it in more directions than this, but for
one in a hundred; in so few agree 19 of 20 that were taken elsewhere,"""
LEAST_THROUGH = 0.1
"""and these look through this share of what is mapped, where the others are stopped by new things.
"""


SURELY_AGREEING = 0.7
"""A scan that the map explains little of, and that shows what the map does in fewer of the
directions in which both show a surface, may have slid along a wall: it would double others."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """In how many directions both a view and the map show a surface, and how they compare there.

    `through`: the view looks through the map's; `before`: it is stopped in front of it.
    """

    compared: int
    through: int
    before: int

    @property
    def through_share(self) -> float:
        """Share of the directions that look through; 0 where too few can be compared."""
        return self.through / self.compared if self.compared >= LEAST_COMPARED else 0.0

    @property
    def agreeing(self) -> float:
        """Share of the directions in which both show the same."""
        return 1 - (self.through + self.before) / max(self.compared, 1)

    @property
    def disagrees(self) -> bool:
        """Whether most of what is seen is not as the map has it."""
        return self.compared >= LEAST_COMPARED and self.agreeing < LEAST_AGREEING

    @property
    def confirms(self) -> bool:
        """Whether the view shows enough of the map, and as the map has it."""
        return self.compared >= LEAST_COMPARED and self.agreeing >= SURELY_AGREEING

    @property
    def is_doubtful(self) -> bool:
        """Whether a good part of what is seen lies beside what the map has."""
        return self.compared >= LEAST_COMPARED and self.agreeing < SURELY_AGREEING

    @property
    def contradicts(self) -> bool:
        """Whether the view was taken elsewhere: new things alone don't explain what it sees."""
        return self.disagrees and self.through_share > LEAST_THROUGH


NOT_COMPARED = Comparison(0, 0, 0)


def compared(seen: SurfacePoints, mapped: SurfacePoints, sensor_xy: Array) -> Comparison:
    """What a view shows, placed in the map frame, beside what the map has around its sensor."""
    to_map = mapped.points_xy - sensor_xy
    facing = -(to_map * mapped.normals_xy).sum(axis=1) > FACING * np.hypot(*to_map.T)
    layers = int(max(seen.level.max(initial=0), mapped.level.max(initial=0))) + 1
    ours = _nearest(seen.points_xy - sensor_xy, seen.level, layers)
    theirs = _nearest(to_map[facing], mapped.level[facing], layers)
    both = np.isfinite(ours) & np.isfinite(theirs)
    off, slack = ours[both] - theirs[both], AGREE_M + AGREE_PER_M * theirs[both]
    return Comparison(int(both.sum()), int((off > slack).sum()), int((off < -slack).sum()))


def _nearest(points_xy: Array, level: NDArray[np.intp], layers: int) -> Array:
    """(layers * BEARINGS,) range of the nearest point (N, 2) by layer and bearing; inf for none."""
    turn = np.arctan2(points_xy[:, 1], points_xy[:, 0]) / (2 * math.pi) + 0.5
    direction = np.minimum((turn * BEARINGS).astype(np.intp), BEARINGS - 1)
    nearest = np.full(layers * BEARINGS, np.inf)
    np.minimum.at(nearest, level * BEARINGS + direction, np.hypot(*points_xy.T))
    return nearest
