"""Rooms of an occupancy grid: basins of free space that narrow passages part (Bormann 2016, §III).

The distance to the nearest obstacle is flooded from its peaks downwards. Where two basins meet, the
passage is twice as wide as the field is high there; if it is as narrow as a doorway, and narrower
than both sides, they are two rooms. For furnished homes, merging beats splitting.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways import DoorwayShape, find_doorways
from afkb_mapping.free_space import Mask, free_space, seen_space
from afkb_mapping.outlines import outline_of_cells
from afkb_mapping.room_borders import cut_at_doorways

Labels = NDArray[np.int32]
Box = tuple[int, int, int, int]

WIDEST_DOOR_M = 2.4
"""A wider passage joins: openings without a door, as between kitchen and dining room."""
NARROWING = 0.75
"""A passage wider than this part of the narrower side is no narrowing: it joins."""
LEAST_ROOM_M2 = 2.5
"""Less than this is a niche or a closet, and belongs to the room it opens to."""


@dataclass(frozen=True, slots=True, eq=False)
class RoomShape:
    """One room: its label in the grid, area (m²), outline (N, 2) and a point inside, map frame."""

    label: int
    area: float
    polygon_xy: NDArray[np.float64]
    inside_xy: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """Rooms and doorways of a grid; `labels` (rows, cols) int32 as the grid, 0 = no room."""

    labels: Labels
    rooms: tuple[RoomShape, ...]
    doorways: tuple[DoorwayShape, ...]


def segment_rooms(grid: OccupancyGrid) -> Segmentation:
    """The rooms of the grid, largest first, with the doorways between them."""
    least_cells = LEAST_ROOM_M2 / grid.resolution_m**2
    clearance = _clearance(free_space(grid), grid.resolution_m)
    labels = _absorb_niches(_basins(clearance), clearance, least_cells)
    if not labels.any():
        seen = seen_space(grid)
        if seen.sum() < least_cells:
            return Segmentation(labels, (), ())
        labels, clearance = seen.astype(np.int32), _clearance(seen, grid.resolution_m)
    labels = _numbered(labels)
    doorways = find_doorways(labels, clearance, grid)
    labels = cut_at_doorways(labels, doorways, grid)
    rooms = tuple(_shape(labels, label, clearance, grid) for label in range(1, labels.max() + 1))
    return Segmentation(labels, rooms, doorways)


def _clearance(free: Mask, resolution: float) -> NDArray[np.float32]:
    """Distance to the nearest obstacle, m; the edge of the grid is one."""
    distance = ndimage.distance_transform_edt(np.pad(free, 1))[1:-1, 1:-1] * resolution
    # To the obstacle's border, not its middle.
    return np.asarray(np.maximum(distance - resolution / 2, 0), dtype=np.float32)


def _basins(clearance: NDArray[np.float32]) -> Labels:
    from afkb_mapping.flood_kernel import flood

    flat = np.flatnonzero(clearance > 0)
    order = flat[np.argsort(-clearance.ravel()[flat], kind="stable")]
    labels: Labels = flood(clearance, order.astype(np.int64), WIDEST_DOOR_M / 2, NARROWING)
    return labels


def _absorb_niches(labels: Labels, clearance: NDArray[np.float32], least_cells: float) -> Labels:
    """Small basins given to the neighbour with the widest passage; without one, dropped."""
    labels = np.pad(labels, 1)
    width = np.pad(clearance, 1)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    boxes = [(0, 0, 0, 0), *(_box(window) for window in ndimage.find_objects(labels))]
    while (small := np.flatnonzero((sizes > 0) & (sizes < least_cells))).size:
        label = int(small[np.argmin(sizes[small])])
        top, left, bottom, right = boxes[label]
        around = np.s_[top - 1 : bottom + 1, left - 1 : right + 1]
        heir = _widest_neighbour(labels[around], label, width[around])
        labels[around][labels[around] == label] = heir
        if heir:
            sizes[heir] += sizes[label]
            boxes[heir] = _union(boxes[heir], boxes[label])
        sizes[label] = 0
    return labels[1:-1, 1:-1]


def _box(window: tuple[slice, slice] | None) -> Box:
    """Top, left, bottom, right (half-open) of a window; zeros for none."""
    if window is None:
        return (0, 0, 0, 0)
    rows, cols = window
    return (rows.start, cols.start, rows.stop, cols.stop)


def _union(a: Box, b: Box) -> Box:
    return (min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3]))


def _widest_neighbour(labels: Labels, label: int, clearance: NDArray[np.float32]) -> int:
    rim = ndimage.binary_dilation(labels == label, np.ones((3, 3)))
    rim &= (labels != label) & (labels > 0)
    return int(labels[rim][np.argmax(clearance[rim])]) if rim.any() else 0


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
