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
Cells = NDArray[np.intp]

NARROWEST_M = 0.5
"""Nobody passes a narrower gap: it is a hole in the wall, or in what was seen of it."""
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
    for pair, cells in _touching(labels):
        for place in _connected(cells):
            heights = clearance[place[:, 0], place[:, 1]]
            widest = int(np.argmax(heights))
            jambs = _jambs(labels, place[widest], float(heights[widest]) / grid.resolution_m)
            if jambs is not None:
                doorways.append(_doorway(labels, jambs, pair, grid))
    return tuple(d for d in doorways if d.width >= NARROWEST_M)


def connected_rooms(labels: Labels, clearance: NDArray[np.float32]) -> tuple[tuple[int, int], ...]:
    """Pairs of rooms, smaller label first, between which one can pass, doorway or none."""
    return tuple(
        pair
        for pair, cells in _touching(labels)
        if 2 * float(clearance[cells[:, 0], cells[:, 1]].max()) >= NARROWEST_M
    )


def _touching(labels: Labels) -> list[tuple[tuple[int, int], Cells]]:
    """Pairs of rooms (smaller label first) with the cells (N, 2) of the first at the second."""
    found = []
    for dr, dc in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = labels[: labels.shape[0] - dr, max(0, -dc) : labels.shape[1] - max(0, dc)]
        there = labels[dr:, max(0, dc) : labels.shape[1] + min(0, dc)]
        rows, cols = np.nonzero((here != there) & (here > 0) & (there > 0))
        a, b = here[rows, cols], there[rows, cols]
        cols = cols + max(0, -dc)
        first = a < b
        row, col = np.where(first, rows, rows + dr), np.where(first, cols, cols + dc)
        found.append(np.column_stack([np.minimum(a, b), np.maximum(a, b), row, col]))
    touching = np.unique(np.concatenate(found), axis=0).astype(np.intp)
    if not len(touching):
        return []
    pairs, starts = np.unique(touching[:, :2], axis=0, return_index=True)
    parts = np.split(touching[:, 2:], starts[1:])
    return [((int(a), int(b)), cells) for (a, b), cells in zip(pairs, parts, strict=True)]


def _connected(cells: Cells) -> list[Cells]:
    """Cells (N, 2) by connected place, in order of rows."""
    low = cells.min(axis=0)
    mask = np.zeros(np.ptp(cells, axis=0) + 1, dtype=bool)
    mask[tuple((cells - low).T)] = True
    places, count = ndimage.label(mask, structure=np.ones((3, 3)))
    number = places[tuple((cells - low).T)]
    return [cells[number == n] for n in range(1, count + 1)]


def _jambs(labels: Labels, cell: Cells, clearance: float) -> Array | None:
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
