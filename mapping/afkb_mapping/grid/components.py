"""Connected groups of grid squares; OpenCV's would wake a thread for each of many small grids."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

LEFT, TOP, WIDTH, HEIGHT, AREA = range(5)
"""Columns of a group's measures, in squares; left to right is along the grid's second axis."""


@kernel
def components(
    grid: NDArray[np.uint8], diagonal: bool
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Labels (X, Y) of the groups of squares that aren't 0, from 1, and measures (groups + 1, 5).

    With `diagonal`, squares that touch at a corner are connected, too. Row 0 of the measures is
    that of no group. Groups are numbered as OpenCV does it: by the first block of two by two
    squares, or where corners don't count, by the first square, in which they lie.
    """
    rows, cols = grid.shape
    labels = np.zeros((rows, cols), np.int32)
    measures = np.zeros((rows * cols + 1, 5), np.int32)
    stack = np.empty((rows * cols, 2), np.int32)
    block = 2 if diagonal else 1
    count = 0
    for r0 in range(0, rows, block):
        for c0 in range(0, cols, block):
            for r in range(r0, min(r0 + block, rows)):
                for c in range(c0, min(c0 + block, cols)):
                    if grid[r, c] != 0 and labels[r, c] == 0:
                        count += 1
                        _flood(grid, labels, r, c, count, diagonal, stack, measures[count])
    return labels, measures[: count + 1]


@kernel
def _flood(
    grid: NDArray[np.uint8],
    labels: NDArray[np.int32],
    row: int,
    col: int,
    name: int,
    diagonal: bool,
    stack: NDArray[np.int32],
    measures: NDArray[np.int32],
) -> None:
    """Give a name to the group of a square and write its measures; `stack` is scratch."""
    rows, cols = grid.shape
    left = right = col
    top = bottom = row
    labels[row, col] = name
    stack[0, 0], stack[0, 1] = row, col
    height, area = 1, 0
    while height > 0:
        height -= 1
        area += 1
        r, c = stack[height, 0], stack[height, 1]
        left, right, top, bottom = min(left, c), max(right, c), min(top, r), max(bottom, r)
        for i in range(max(r - 1, 0), min(r + 2, rows)):
            for j in range(max(c - 1, 0), min(c + 2, cols)):
                if grid[i, j] == 0 or labels[i, j] != 0 or (not diagonal and i != r and j != c):
                    continue
                labels[i, j] = name
                stack[height, 0], stack[height, 1] = i, j
                height += 1
    measures[LEFT], measures[TOP], measures[AREA] = left, top, area
    measures[WIDTH], measures[HEIGHT] = right - left + 1, bottom - top + 1
