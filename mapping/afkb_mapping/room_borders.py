"""Straight borders between rooms: cut at the doorways instead of where basins happened to meet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways import DoorwayShape

Labels = NDArray[np.int32]


def cut_at_doorways(
    labels: Labels, doorways: Sequence[DoorwayShape], grid: OccupancyGrid
) -> Labels:
    """The labels with each room ending at its doorways; what lies beyond goes to its neighbours."""
    lines = np.zeros(labels.shape, dtype=bool)
    for doorway in doorways:
        _draw(lines, doorway, labels, grid)
    cores = _largest_parts(np.where(lines, 0, labels))
    filled = spread(cores, (labels > 0) & ~lines)
    return spread(filled, labels > 0)


def _draw(
    lines: NDArray[np.bool_], doorway: DoorwayShape, labels: Labels, grid: OccupancyGrid
) -> None:
    """Mark the cells between the jambs, of the two rooms only."""
    import cv2

    across = np.array([-np.sin(doorway.yaw), np.cos(doorway.yaw)])
    half = doorway.width / 2 + grid.resolution_m
    middle = np.array([doorway.x, doorway.y])
    ends = np.array([middle - half * across, middle + half * across])
    cells = np.floor((ends - grid.origin_xy) / grid.resolution_m).astype(int)
    cells = np.clip(cells, 0, np.array(labels.shape[::-1]) - 1)
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    drawn = np.zeros(tuple(high - low)[::-1], dtype=np.uint8)
    # Four-connected, so that no label slips through it diagonally.
    cv2.line(drawn, (cells[0] - low).tolist(), (cells[1] - low).tolist(), 1, lineType=cv2.LINE_4)
    window = np.s_[low[1] : high[1], low[0] : high[0]]
    lines[window] |= (drawn > 0) & np.isin(labels[window], doorway.labels)


def _largest_parts(labels: Labels) -> Labels:
    """Of each label the largest four-connected part, 0 elsewhere."""
    kept = np.zeros_like(labels)
    for label, window in enumerate(ndimage.find_objects(labels), start=1):
        if window is None:
            continue
        parts, _ = ndimage.label(labels[window] == label)
        sizes = np.bincount(parts.ravel())
        sizes[0] = 0
        kept[window][parts == np.argmax(sizes)] = label
    return kept


def spread(labels: Labels, within: NDArray[np.bool_]) -> Labels:
    """(rows, cols) labels grown step by step into the unlabelled cells of `within` they touch."""
    labels = np.pad(labels, 1)
    empty = np.pad(within, 1) & (labels == 0)
    while empty.any():
        rows, cols = np.nonzero(empty)
        beside = [labels[rows + dr, cols + dc] for dr, dc in ((0, 1), (0, -1), (1, 0), (-1, 0))]
        found = np.max(beside, axis=0)
        if not found.any():
            break
        labels[rows, cols] = found
        empty[rows, cols] = found == 0
    return labels[1:-1, 1:-1]
