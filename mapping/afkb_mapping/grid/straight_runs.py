"""How long what stands beside a passage runs straight: walls are longer than cabinets are wide."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb_mapping.kernels import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LONGEST_M = 2.0
"""No more is measured to either side."""
JAMB_REACH_M = 0.15
"""What stands this near to where a jamb ends is the jamb."""
FACE_M = 0.08
"""What lies this near to it, its own cell and those beside it, is its face: a wall that runs on
from a door's frame is further off."""
TORN_M = 0.25
"""A run goes on over holes as long: seen at a slant, a wall's cells lie apart."""
TILTS = 7
MOST_TILT_RAD = math.radians(15.0)
"""A jamb runs along the passage's line or straight across it, but for this."""


def runs_m(standing: Mask, jambs_xy: Array, grid: OccupancyGrid) -> tuple[float, float]:
    """Longest straight runs of marked cells (rows, cols) at both jambs (2, 2), m.

    Along the line between them or across it; 0 where nothing is marked at a jamb.
    """
    along = _runs(standing, jambs_xy, grid, 0.0, JAMB_REACH_M, MOST_TILT_RAD)
    across = _runs(standing, jambs_xy, grid, math.pi / 2, JAMB_REACH_M, MOST_TILT_RAD)
    return max(along[0], across[0]), max(along[1], across[1])


def thickness_m(standing: Mask, jambs_xy: Array, grid: OccupancyGrid) -> tuple[float, float]:
    """How far marked cells (rows, cols) run on from both jambs (2, 2), the way one passes, m."""
    return _runs(standing, jambs_xy, grid, math.pi / 2, FACE_M, 0.0)


def _runs(
    marked: Mask, jambs_xy: Array, grid: OccupancyGrid, turn: float, reach_m: float, tilt: float
) -> tuple[float, float]:
    """Of both jambs the longest run at an angle to the line between them, give or take a tilt."""
    resolution = grid.resolution_m
    cells = ((jambs_xy - np.array(grid.origin_xy)) / resolution).tolist()
    angle = math.atan2(cells[1][1] - cells[0][1], cells[1][0] - cells[0][0]) + turn
    limits = tuple(m / resolution for m in (reach_m, TORN_M, LONGEST_M))
    first, second = (_longest(marked, x, y, angle, tilt, *limits) * resolution for x, y in cells)
    return first, second


@kernel
def _longest(
    marked: Mask,
    x: float,
    y: float,
    angle: float,
    tilt: float,
    reach: float,
    torn: float,
    most: float,
) -> float:
    """The longest run in a direction through a marked cell within reach of a point, in cells."""
    n, best = int(reach) + 1, 0.0
    for row in range(max(0, int(y) - n), min(marked.shape[0], int(y) + n + 1)):
        for col in range(max(0, int(x) - n), min(marked.shape[1], int(x) + n + 1)):
            if not marked[row, col] or math.hypot(col + 0.5 - x, row + 0.5 - y) > reach:
                continue
            for k in range(TILTS):
                tilted = angle + tilt * (2 * k / (TILTS - 1) - 1)
                before = _run(marked, row, col, tilted + math.pi, torn, most)
                best = max(best, before + _run(marked, row, col, tilted, torn, most) + 1)
    return best


@kernel
def _run(marked: Mask, row: int, col: int, angle: float, torn: float, most: float) -> float:
    """How far marked cells go on from one in a direction; the cells beside the line count."""
    dx, dy = math.cos(angle), math.sin(angle)
    last, k = 0.0, 1.0
    while k - last <= torn and k <= most:
        for aside in range(-1, 2):
            r = math.floor(row + 0.5 + k * dy + aside * dx)
            c = math.floor(col + 0.5 + k * dx - aside * dy)
            if 0 <= r < marked.shape[0] and 0 <= c < marked.shape[1] and marked[r, c]:
                last = k
        k += 1.0
    return last
