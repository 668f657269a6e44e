"""How likely a gap is a doorway, by all that the map knows of what stands at it and around it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb_mapping.bounds import WALL_M
from afkb_mapping.doorways.detour import room_to_room, way_free
from afkb_mapping.grid.free_space import OCCUPIED_ABOVE
from afkb_mapping.grid.straight_runs import JAMB_REACH_M, runs_m, thickness_m
from afkb_mapping.trapezoids import ramp
from afkb_mapping.upright_cells import UprightCells

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

UNKNOWN_HEIGHT = 0.6
"""P(wall | straight jamb whose height no view has shown)."""
TALL_SHARE = (0.1, 0.4)
"""One looks over a cabinet from everywhere, past the edge of a wall from here and there."""
LOW_JAMB = 0.6
"""P(doorway | one of its jambs is low): a cabinet that stands before the wall's end."""
LOW_JAMB_IN_MAP = 0.3
"""The same of a gap that only the map shows: every aisle between a counter and a wall is one,
whereas a scan shows its jambs to a centimetre."""
KNEE_JAMB, MOSTLY = 0.2, 0.5
"""The same of what is mostly knee-high, as a bed or a seat is."""
WALL_BESIDE_M = (WALL_M - 0.2, WALL_M)
"""At least one jamb is of a wall: straight and tall for as long as the second. What is no longer
than the first is a cabinet's or a refrigerator's side, or the picture that hangs there."""
WALL_THICK_M = (0.5, 1.0)
"""Of a gap that only the map shows at least one jamb is as deep as a wall is thick, and noise
blurs; between what is deeper on both sides, as wardrobes are, one walks along an aisle."""
OBSTRUCTED = (0.1, 0.4)
"""Share of the line between the jambs, on which something stands: a door leaf, or a shelf."""
FAINT = 0.05
"""Below this no grid makes it likely."""
ACROSS_STEP_M = 0.1


class DoorwayJudge:
    """Holds gaps against the grid, and against what depth saw to be tall, low, or in the way.

    `standing` and `free`: (rows, cols) of the grid, where things stand, and where floor is free.
    """

    def __init__(self, upright: UprightCells, grid: OccupancyGrid) -> None:
        self._upright = upright
        self._grid = grid
        self._tall = upright.mark_tall(grid)
        seen = upright.mark(grid)
        with np.errstate(invalid="ignore"):
            self.standing = seen | (grid.probability > OCCUPIED_ABOVE)
        self.free = way_free(grid, seen)

    def doorway(self, jambs_xy: Array, gap: float, low_jamb: float = LOW_JAMB) -> float:
        """Probability of a doorway between jambs (2, 2), m, where a gap is as likely as that.

        `low_jamb`: P(doorway | one of its jambs is low).
        """
        tall = [self._upright.tall(jamb[None], JAMB_REACH_M) for jamb in jambs_xy]
        p = gap
        for jamb, share in zip(jambs_xy, tall, strict=True):
            p *= self._is_jamb(jamb[None], share, low_jamb)
        p *= 1 - ramp(self._stands_between(jambs_xy), OBSTRUCTED)
        if p >= FAINT and not any(map(math.isnan, tall)):
            p *= beside_wall(jambs_xy, self._tall, self._grid)
        return p * room_to_room(jambs_xy, self.free, self._grid) if p >= FAINT else 0.0

    def doorway_of_map(self, jambs_xy: Array, gap: float) -> float:
        """The same of a gap that no single view has shown."""
        p = self.doorway(jambs_xy, gap, LOW_JAMB_IN_MAP)
        return p * through_wall(jambs_xy, self._tall, self._grid)

    def _is_jamb(self, jamb_xy: Array, tall: float, low_jamb: float) -> float:
        """Probability that what stands at a point (1, 2), m, ends or hides the end of a wall."""
        if math.isnan(tall):
            return UNKNOWN_HEIGHT
        knee = self._upright.knee_high(jamb_xy, JAMB_REACH_M)
        low = KNEE_JAMB if knee > MOSTLY else low_jamb
        return low + (1 - low) * ramp(tall, TALL_SHARE)

    def _stands_between(self, jambs_xy: Array) -> float:
        """Share of the line between two jambs on which something stands."""
        along = jambs_xy[1] - jambs_xy[0]
        width = float(np.linalg.norm(along))
        inner = np.arange(JAMB_REACH_M, width - JAMB_REACH_M, ACROSS_STEP_M)
        if not len(inner):
            return 0.0
        return self._upright.stands_on(jambs_xy[0] + np.outer(inner / width, along))


def beside_wall(jambs_xy: Array, tall: Mask, grid: OccupancyGrid) -> float:
    """How well one of two jambs (2, 2), m, is of a wall, 0 to 1; `tall`: (rows, cols)."""
    return ramp(max(runs_m(tall, jambs_xy, grid)), WALL_BESIDE_M)


def through_wall(jambs_xy: Array, tall: Mask, grid: OccupancyGrid) -> float:
    """How well a gap between jambs (2, 2), m, leads through a wall and along no aisle, 0 to 1."""
    return 1 - ramp(min(thickness_m(tall, jambs_xy, grid)), WALL_THICK_M)
