"""Rooms of an occupancy grid: free space cut along the lines on which more than openings lies.

Lines that may bound a room are those on which a wall would go on if it went on, those across narrow
places, and doorways that views have shown. Those are cut that walls go on from, with rooms on both
sides of them, and the mouths of corridors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways.doorway import DoorwayShape, connected_rooms, find_doorways
from afkb_mapping.doorways.merger import SeenDoorway
from afkb_mapping.grid.free_space import Mask, free_space, seen_space
from afkb_mapping.segmentation.niches import LEAST_ROOM_M2
from afkb_mapping.segmentation.open_plan import Belief, Purpose, divided
from afkb_mapping.segmentation.parts import border_lines, parted
from afkb_mapping.segmentation.wall_lines import Line
from afkb_mapping.things.outlines import outline_of_cells

Labels = NDArray[np.int32]

HANGS_IN_WALL = 0.75
"""What a doorway at least so likely hangs in is a wall, though it looks like furniture."""


@dataclass(frozen=True, slots=True, eq=False)
class RoomShape:
    """One room: its label in the grid, area (m²), outline (N, 2) and a point inside, map frame."""

    label: int
    area: float
    polygon_xy: NDArray[np.float64]
    inside_xy: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """Rooms and doorways of a grid; `labels` (rows, cols) int32 as the grid, 0 = no room.

    `doorways`: wherever two rooms meet, doors or openings as wide as a hall; `connected`: pairs of
    labels between which one can pass; `lines`: on which a room may end, by what stands.
    """

    labels: Labels
    rooms: tuple[RoomShape, ...]
    doorways: tuple[DoorwayShape, ...]
    connected: tuple[tuple[int, int], ...] = ()
    lines: tuple[Line, ...] = ()


def segment_rooms(grid: OccupancyGrid, doorways: Sequence[SeenDoorway] = ()) -> Segmentation:
    """The rooms of the grid, largest first, with the doorways between them.

    `doorways`: that views have shown, each of which counts as a wall as far as it is likely.
    """
    free = free_space(grid, [_jambs(d) for d in doorways if d.probability >= HANGS_IN_WALL])
    clearance = _clearance(free, grid.resolution_m)
    lines = border_lines(free, clearance, grid)
    labels = parted(free, clearance, grid, lines, doorways)
    if not labels.any():
        labels, lines = seen_space(grid).astype(np.int32), []
        if labels.sum() < LEAST_ROOM_M2 / grid.resolution_m**2:
            return Segmentation(np.zeros_like(labels), (), ())
    return _described(labels, lines, grid)


def divide_by_purpose(
    segmentation: Segmentation, grid: OccupancyGrid, purpose: Purpose, prior: Belief
) -> Segmentation:
    """The segmentation with open plans divided where what is in their parts tells of two purposes.

    `purpose`: posterior of a part (rows, cols) of the grid; `prior`: of any room.
    """
    lines = segmentation.lines
    labels = divided(segmentation.labels, lines, purpose, prior, grid.resolution_m)
    if labels.max() == segmentation.labels.max():
        return segmentation
    return _described(labels, lines, grid)


def _described(labels: Labels, lines: Sequence[Line], grid: OccupancyGrid) -> Segmentation:
    labels, clearance = _numbered(labels), _clearance(labels > 0, grid.resolution_m)
    rooms = tuple(_shape(labels, label, clearance, grid) for label in range(1, labels.max() + 1))
    doorways = find_doorways(labels, clearance, grid)
    return Segmentation(labels, rooms, doorways, connected_rooms(labels, clearance), tuple(lines))


def _jambs(doorway: SeenDoorway) -> NDArray[np.float64]:
    """(2, 2) m, map frame: ends of a doorway's width."""
    half = np.array([-np.sin(doorway.yaw), np.cos(doorway.yaw)]) * doorway.width / 2
    jambs: NDArray[np.float64] = np.array([doorway.x, doorway.y]) + np.array([half, -half])
    return jambs


def _clearance(free: Mask, resolution: float) -> NDArray[np.float32]:
    """Distance to the nearest obstacle, m; the edge of the grid is one."""
    distance = ndimage.distance_transform_edt(np.pad(free, 1))[1:-1, 1:-1] * resolution
    # To the obstacle's border, not its middle.
    return np.asarray(np.maximum(distance - resolution / 2, 0), dtype=np.float32)


def _numbered(labels: Labels) -> Labels:
    """Labels 1 … n, largest room first."""
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    order = np.argsort(-sizes, kind="stable")[: np.count_nonzero(sizes)]
    renumbered = np.zeros(len(sizes), dtype=np.int32)
    renumbered[order] = np.arange(1, len(order) + 1)
    return renumbered[labels]


def _shape(
    labels: Labels, label: int, clearance: NDArray[np.float32], grid: OccupancyGrid
) -> RoomShape:
    mask = labels == label
    origin = np.array(grid.origin_xy)
    polygon = outline_of_cells(mask.astype(np.uint8), grid.resolution_m, origin, axes="yx")
    row, col = np.unravel_index(np.argmax(np.where(mask, clearance, -1.0)), mask.shape)
    x, y = (np.array([col, row]) + 0.5) * grid.resolution_m + np.array(grid.origin_xy)
    return RoomShape(label, float(mask.sum() * grid.resolution_m**2), polygon, (float(x), float(y)))
