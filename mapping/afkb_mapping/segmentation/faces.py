"""Free space cut along every line that may bound a room, and joined again where none does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorway_merger import SeenDoorway
from afkb_mapping.doorways import DoorwayShape
from afkb_mapping.segmentation.borders import borders
from afkb_mapping.segmentation.merging import FaceGraph
from afkb_mapping.segmentation.narrow_lines import lines_across, narrow_lines
from afkb_mapping.segmentation.spreading import spread
from afkb_mapping.segmentation.wall_lines import Line, drawn, wall_lines

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]
Array = NDArray[np.float64]
Clearance = NDArray[np.float32]


def border_lines(free: Mask, clearance: Clearance, grid: OccupancyGrid) -> list[Line]:
    """Every line of free space that may bound a room, by what stands."""
    return [*wall_lines(free, grid.resolution_m), *narrow_lines(clearance, grid)]


def joined_faces(
    free: Mask,
    clearance: Clearance,
    grid: OccupancyGrid,
    lines: Sequence[Line],
    doorways: Sequence[SeenDoorway],
) -> Labels:
    """(rows, cols) label of the room of each free cell, 0 elsewhere; labels are not consecutive.

    A doorway that views have shown counts as a wall as far as it is likely.
    """
    closed = _closed(doorways, grid)
    cut = drawn(lines, free.shape) | (closed > 0)
    parts, _ = ndimage.label(free & ~cut)
    faces = spread(parts.astype(np.int32), free)
    areas: Array = np.bincount(faces.ravel()).astype(np.float64) * grid.resolution_m**2
    areas[0] = 0.0
    widths = np.zeros(len(areas))
    np.maximum.at(widths, faces.ravel(), 2 * clearance.ravel())
    graph = FaceGraph(areas, widths, borders(faces, closed, grid.resolution_m))
    graph.merge_open()
    graph.absorb_niches()
    return graph.rooms()[faces]


def _closed(doorways: Sequence[SeenDoorway], grid: OccupancyGrid) -> NDArray[np.float32]:
    """(rows, cols) probability that a doorway's line runs through a cell."""
    closed = np.zeros(grid.probability.shape, dtype=np.float32)
    for seen in sorted(doorways, key=lambda d: d.probability):
        shape = DoorwayShape(seen.x, seen.y, seen.yaw, seen.width, (1, 2))
        closed[drawn(lines_across([shape], grid), closed.shape)] = seen.probability
    return closed
