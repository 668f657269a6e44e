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
REACH_M = 0.15
"""What stands this near to where a jamb ends is the jamb."""
TORN_M = 0.25
"""A run goes on over holes as long: seen at a slant, a wall's cells lie apart."""
TILTS = 7
MOST_TILT_RAD = math.radians(15.0)
"""A jamb runs along the passage's line or straight across it, but for this."""


def runs_m(standing: Mask, jambs_xy: Array, grid: OccupancyGrid) -> tuple[float, float]:
    """Longest straight runs of marked cells (rows, cols) at both jambs (2, 2), m.

    Along the line between them or across it; 0 where nothing is marked at a jamb.
    """
    corner, resolution = np.array(grid.origin_xy), grid.resolution_m
    (x0, y0), (x1, y1) = ((jambs_xy - corner) / resolution).tolist()
    along = math.atan2(y1 - y0, x1 - x0)
    reach, torn, most = (m / resolution for m in (REACH_M, TORN_M, LONGEST_M))
    first, second = (
        _longest(standing, x, y, along, reach, torn, most) * resolution
        for x, y in ((x0, y0), (x1, y1))
    )
    return first, second


@kernel
def _longest(
    marked: Mask, x: float, y: float, along: float, reach: float, torn: float, most: float
) -> float:
    """The longest run through a marked cell within reach of a point, all in cells."""
    n, best = int(reach) + 1, 0.0
    for row in range(max(0, int(y) - n), min(marked.shape[0], int(y) + n + 1)):
        for col in range(max(0, int(x) - n), min(marked.shape[1], int(x) + n + 1)):
            if not marked[row, col] or math.hypot(col + 0.5 - x, row + 0.5 - y) > reach:
                continue
            for quarter in range(2):
                for k in range(TILTS):
                    tilt = MOST_TILT_RAD * (2 * k / (TILTS - 1) - 1)
                    angle = along + quarter * math.pi / 2 + tilt
                    before = _run(marked, row, col, angle + math.pi, torn, most)
                    best = max(best, before + _run(marked, row, col, angle, torn, most) + 1)
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
