"""Lines on which walls would go on, if they went on: where rooms may end though nothing stands.

A wall that ends at an opening points along the border that people would draw there, be it a door
or three metres wide (the lines of ROSE², Luperto et al. 2022, but for ends of walls only).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Mask = NDArray[np.bool_]
Array = NDArray[np.float64]
Line = NDArray[np.intp]
"""(N, 2) column and row of its corners."""

STRAIGHT_M = 0.12
"""An edge is straight where it bends by no more: two or three cells, as noise does."""
WALL_M = 0.5
"""A shorter straight edge is as likely the end of a wall as its face, and points nowhere."""
LONGEST_M = 6.0
"""No line is drawn further: nobody takes two walls for one across a hall."""
CLEAR_CELLS = 2.5
"""A line is clear of the wall it leaves once the next obstacle is this far,"""
HIT_CELLS = 1.5
"""and ends where one is this near: jambs of one doorway lie a cell or so off each other's line."""
LEAVES_WITHIN_CELLS = 6
"""A line that is not clear after so many cells runs along a wall."""


def wall_lines(free: Mask, resolution_m: float) -> list[Line]:
    """Lines that carry straight edges of free space on, to the jamb or the wall they meet."""
    padded = np.pad(free, 1)
    distance, nearest = ndimage.distance_transform_edt(padded, return_indices=True)
    lines = []
    reach = np.arange(int(LONGEST_M / resolution_m))[:, None]
    for corner, along in _ends_of_edges(padded, resolution_m):
        cells = np.round(corner + reach * along).astype(int)
        cells = cells[((cells >= 0) & (cells < padded.shape[::-1])).all(axis=1)]
        end = _end(distance[cells[:, 1], cells[:, 0]])
        if end is not None:
            col, row = (int(n) for n in cells[end])
            jamb = nearest[:, row, col]
            corners = [corner.astype(int), np.array([col, row]), jamb[::-1]]
            lines.append(np.array(corners, dtype=np.intp) - 1)
    return lines


def drawn(lines: Iterable[Line], shape: tuple[int, ...]) -> Mask:
    """(rows, cols) cells on lines; no label slips through one diagonally."""
    import cv2

    cells = np.zeros(shape, dtype=np.uint8)
    for line in lines:
        for start, end in itertools.pairwise(line.tolist()):
            cv2.line(cells, start, end, 1, lineType=cv2.LINE_4)
    mask: Mask = cells > 0
    return mask


def _ends_of_edges(padded: Mask, resolution_m: float) -> Iterator[tuple[Array, Array]]:
    """Both ends (2,) column and row of each long straight edge, and the unit way on from there."""
    import cv2

    contours, _ = cv2.findContours(padded.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    for contour in contours:
        corners = cv2.approxPolyDP(contour, STRAIGHT_M / resolution_m, True)
        points = corners.reshape(-1, 2).astype(np.float64)
        if len(points) < 3:
            continue
        for others in (np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)):
            lengths = np.linalg.norm(points - others, axis=1)
            for corner, other, length in zip(points, others, lengths, strict=True):
                if length * resolution_m >= WALL_M:
                    yield corner, (corner - other) / length


def _end(distances: Array) -> int | None:
    """Index at which a line meets the next obstacle, by the distances to any along it, in cells.

    None where it does not lead through free space, or meets nothing.
    """
    away = np.flatnonzero(distances > CLEAR_CELLS)
    if not len(away) or away[0] > LEAVES_WITHIN_CELLS:
        return None
    hit = np.flatnonzero(distances[away[0] :] <= HIT_CELLS)
    return int(away[0] + hit[0]) if len(hit) else None
