"""Doorways: where two segmented rooms touch, at the widest point of the passage."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid

Labels = NDArray[np.int32]
Array = NDArray[np.float64]
Window = tuple[slice, slice]

SEARCH = 2.5
"""The opposite jamb is sought up to this many times the clearance away."""
OPPOSITE = 0.5
"""Least cosine between the ways to it and straight away from the nearer jamb."""
BESIDE_CELLS = 12
"""Cells on either side of a doorway that tell which room it leads to."""


@dataclass(frozen=True, slots=True)
class DoorwayShape:
    """A passage: its middle (m, map frame), direction through it (rad), width (m), and the rooms.

    `yaw` points from the room labelled `labels[0]` to that labelled `labels[1]`.
    """

    x: float
    y: float
    yaw: float
    width: float
    labels: tuple[int, int]


def find_doorways(
    labels: Labels, clearance: NDArray[np.float32], grid: OccupancyGrid
) -> tuple[DoorwayShape, ...]:
    """One doorway per place where two rooms touch; `clearance` (rows, cols), m, to obstacles."""
    doorways = []
    for a, b in _touching_pairs(labels):
        touching = (labels == a) & ndimage.binary_dilation(labels == b, np.ones((3, 3)))
        places, count = ndimage.label(touching, structure=np.ones((3, 3)))
        for place in range(1, count + 1):
            height = np.where(places == place, clearance, -1.0)
            cell = np.array(divmod(int(np.argmax(height)), height.shape[1]))
            jambs = _jambs(labels, cell, float(height.max()) / grid.resolution_m)
            if jambs is not None:
                doorways.append(_doorway(labels, jambs, (a, b), grid))
    return tuple(doorways)


def _jambs(labels: Labels, cell: NDArray[np.intp], clearance: float) -> Array | None:
    """(2, 2) rows and columns of the obstacles on either side of a cell of a passage.

    The nearest one, and the nearest to it on the other side; None where the map ends before that.
    `clearance`: of the cell, in cells.
    """
    reach = int(np.ceil(SEARCH * clearance)) + 3
    low = np.maximum(cell - reach, 0)
    window = labels[low[0] : cell[0] + reach + 1, low[1] : cell[1] + reach + 1]
    obstacles = (np.argwhere(window == 0) + low).astype(np.float64)
    if not len(obstacles):
        return None
    offsets = obstacles - cell
    distances = np.linalg.norm(offsets, axis=1)
    nearest = int(np.argmin(distances))
    across = -offsets[nearest] / distances[nearest]
    opposite = offsets @ across > OPPOSITE * distances
    if not opposite.any():
        return None
    width = np.linalg.norm(obstacles - obstacles[nearest], axis=1)
    return obstacles[[nearest, int(np.argmin(np.where(opposite, width, np.inf)))]]


def _touching_pairs(labels: Labels) -> list[tuple[int, int]]:
    """Pairs of different room labels in neighbouring cells, smaller label first, sorted."""
    pairs: set[tuple[int, int]] = set()
    shifts: list[tuple[Window, Window]] = [
        (np.s_[:, :-1], np.s_[:, 1:]),
        (np.s_[:-1, :], np.s_[1:, :]),
    ]
    shifts += [(np.s_[:-1, :-1], np.s_[1:, 1:]), (np.s_[:-1, 1:], np.s_[1:, :-1])]
    for here, there in shifts:
        a, b = labels[here], labels[there]
        differ = (a != b) & (a > 0) & (b > 0)
        low, high = np.minimum(a, b)[differ], np.maximum(a, b)[differ]
        pairs.update(zip(low.tolist(), high.tolist(), strict=True))
    return sorted(pairs)


def _doorway(
    labels: Labels, jambs: Array, pair: tuple[int, int], grid: OccupancyGrid
) -> DoorwayShape:
    """Measured from jamb to jamb."""
    row, col = jambs.mean(axis=0)
    along = jambs[1] - jambs[0]
    yaw = _towards(labels, (row, col), math.atan2(along[1], -along[0]), pair)
    x, y = (np.array([col, row]) + 0.5) * grid.resolution_m + np.array(grid.origin_xy)
    # Between the faces of the jambs, not between the middles of their cells.
    width = max(float(np.linalg.norm(along)) - 1, 1) * grid.resolution_m
    return DoorwayShape(float(x), float(y), yaw, width, pair)


def _towards(
    labels: Labels, middle: tuple[float, float], yaw: float, pair: tuple[int, int]
) -> float:
    """Of the two directions through a doorway the one that leads into the second room."""
    votes = 0
    for distance in range(1, BESIDE_CELLS):
        for sign in (1, -1):
            row = round(middle[0] + sign * distance * math.sin(yaw))
            col = round(middle[1] + sign * distance * math.cos(yaw))
            if 0 <= row < labels.shape[0] and 0 <= col < labels.shape[1]:
                votes += sign * (
                    int(labels[row, col] == pair[1]) - int(labels[row, col] == pair[0])
                )
    turned = yaw if votes >= 0 else yaw + math.pi
    return math.atan2(math.sin(turned), math.cos(turned))
