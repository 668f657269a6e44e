"""Lines across narrow places, from jamb to jamb: where basins of free space meet (Bormann 2016)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways.doorway import DoorwayShape, find_doorways
from afkb_mapping.segmentation.wall_lines import Line

Clearance = NDArray[np.float32]

WIDEST_M = 6.0
"""Wider places are not looked at."""
NARROWING = 0.9
"""A place is narrow where it is narrower than this part of what it leads to, on both sides."""


def narrow_lines(clearance: Clearance, grid: OccupancyGrid) -> list[Line]:
    """Lines between the jambs of narrow places.

    `clearance` (rows, cols): distance to the nearest obstacle, m.
    """
    from afkb_mapping.grid.flood import flood

    flat = np.flatnonzero(clearance > 0)
    order = flat[np.argsort(-clearance.ravel()[flat], kind="stable")].astype(np.int64)
    basins = flood(clearance, order, WIDEST_M / 2, NARROWING)
    return lines_across(find_doorways(basins, clearance, grid), grid)


def lines_across(doorways: Sequence[DoorwayShape], grid: OccupancyGrid) -> list[Line]:
    """From jamb to jamb of each doorway, and a cell into either."""
    lines = []
    for doorway in doorways:
        across = np.array([-np.sin(doorway.yaw), np.cos(doorway.yaw)])
        half = (doorway.width / 2 + grid.resolution_m) * across
        middle = np.array([doorway.x, doorway.y]) - grid.origin_xy
        ends = np.floor((middle + np.array([half, -half])) / grid.resolution_m)
        lines.append(ends.astype(np.intp))
    return lines
