"""Doorways: where two segmented rooms touch, at the widest point of the passage."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid

Labels = NDArray[np.int32]
Window = tuple[slice, slice]


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
    obstacle_index: NDArray[np.intp] = np.asarray(
        ndimage.distance_transform_edt(labels > 0, return_distances=False, return_indices=True),
        dtype=np.intp,
    )
    doorways = []
    for a, b in _touching_pairs(labels):
        touching = (labels == a) & ndimage.binary_dilation(labels == b, np.ones((3, 3)))
        places, count = ndimage.label(touching, structure=np.ones((3, 3)))
        for place in range(1, count + 1):
            height = np.where(places == place, clearance, -1.0)
            row, col = divmod(int(np.argmax(height)), height.shape[1])
            cell, nearest = np.array([row, col]), obstacle_index[:, row, col]
            doorways.append(_doorway(labels, cell, nearest, (a, b), grid))
    return tuple(doorways)


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
    labels: Labels,
    cell: NDArray[np.intp],
    nearest: NDArray[np.intp],
    pair: tuple[int, int],
    grid: OccupancyGrid,
) -> DoorwayShape:
    """Measured from jamb to jamb: from the nearest obstacle straight across to the opposite one."""
    jamb = nearest.astype(np.float64)
    across = cell - jamb
    length = float(np.linalg.norm(across)) or 1.0
    direction = across / length
    steps = 1
    while _is_room(labels, jamb + direction * steps) or steps <= length:
        steps += 1
    row, col = jamb + direction * steps / 2
    yaw = math.atan2(direction[1], -direction[0])
    yaw = _towards(labels, (row, col), yaw, pair)
    x, y = (np.array([col, row]) + 0.5) * grid.resolution_m + np.array(grid.origin_xy)
    width = max(steps - 1, 1) * grid.resolution_m
    return DoorwayShape(float(x), float(y), yaw, float(width), pair)


def _is_room(labels: Labels, at: NDArray[np.float64]) -> bool:
    row, col = (int(v) for v in np.round(at))
    inside = 0 <= row < labels.shape[0] and 0 <= col < labels.shape[1]
    return inside and bool(labels[row, col] > 0)


def _towards(
    labels: Labels, middle: tuple[float, float], yaw: float, pair: tuple[int, int]
) -> float:
    """Of the two directions through a doorway the one that leads into the second room."""
    reach = 12
    votes = 0
    for distance in range(1, reach):
        for sign in (1, -1):
            row = round(middle[0] + sign * distance * math.sin(yaw))
            col = round(middle[1] + sign * distance * math.cos(yaw))
            if 0 <= row < labels.shape[0] and 0 <= col < labels.shape[1]:
                votes += sign * (
                    int(labels[row, col] == pair[1]) - int(labels[row, col] == pair[0])
                )
    turned = yaw if votes >= 0 else yaw + math.pi
    return math.atan2(math.sin(turned), math.cos(turned))
