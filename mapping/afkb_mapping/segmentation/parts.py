"""Free space cut along the lines that part rooms; what is too small for a room goes to another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways.doorway import DoorwayShape
from afkb_mapping.doorways.merger import SeenDoorway
from afkb_mapping.segmentation.closing import closed_lines
from afkb_mapping.segmentation.narrow_lines import lines_across, narrow_lines
from afkb_mapping.segmentation.niches import without_niches
from afkb_mapping.segmentation.spreading import spread
from afkb_mapping.segmentation.wall_lines import Line, drawn, wall_lines

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]
Clearance = NDArray[np.float32]


def border_lines(free: Mask, clearance: Clearance, grid: OccupancyGrid) -> list[Line]:
    """Every line of free space that may bound a room, by what stands."""
    return [*wall_lines(free, grid.resolution_m), *narrow_lines(clearance, grid)]


def parted(
    free: Mask,
    clearance: Clearance,
    grid: OccupancyGrid,
    lines: Sequence[Line],
    doorways: Sequence[SeenDoorway],
) -> Labels:
    """(rows, cols) label of the room of each free cell, 0 elsewhere; labels are not consecutive.

    Where views have shown a likely doorway, a room ends.
    """
    shapes = [DoorwayShape(d.x, d.y, d.yaw, d.width, (1, 2)) for d in doorways]
    seen = lines_across(shapes, grid)
    likely = [d.probability for d in doorways] + [0.0] * len(lines)
    closed = closed_lines(free, clearance, [*seen, *lines], likely, grid.resolution_m)
    parts, _ = ndimage.label(free & ~closed)
    doors = closed & drawn(seen, free.shape)
    return without_niches(spread(parts.astype(np.int32), free), doors, grid.resolution_m)
