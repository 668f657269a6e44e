"""Beams through a grid, compiled; imported when the first beam is drawn."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def trace_beams(
    verdict: NDArray[np.int8],
    sensor: NDArray[np.float64],
    ends: NDArray[np.float64],
    hit: NDArray[np.bool_],
) -> None:
    """Mark cells that beams pass with -1, and those where they hit with 1, which stays.

    `verdict` (rows, cols) is changed in place; `sensor` (2,) and `ends` (N, 2) are x, y in cells.
    Amanatides and Woo's traversal: every cell that the beam touches.
    """
    for i in range(ends.shape[0]):
        col, row = int(np.floor(sensor[0])), int(np.floor(sensor[1]))
        end_col, end_row = int(np.floor(ends[i, 0])), int(np.floor(ends[i, 1]))
        dx, dy = ends[i, 0] - sensor[0], ends[i, 1] - sensor[1]
        step_col, step_row = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
        per_col = abs(1.0 / dx) if dx != 0 else np.inf
        per_row = abs(1.0 / dy) if dy != 0 else np.inf
        edge_col = col + 1 - sensor[0] if dx > 0 else sensor[0] - col
        edge_row = row + 1 - sensor[1] if dy > 0 else sensor[1] - row
        to_col = edge_col * per_col if dx != 0 else np.inf
        to_row = edge_row * per_row if dy != 0 else np.inf
        for _ in range(abs(end_col - col) + abs(end_row - row)):
            if verdict[row, col] == 0:
                verdict[row, col] = -1
            # The end's row or column is kept once reached: rounding must not lead past the array.
            if row == end_row or (col != end_col and to_col < to_row):
                col += step_col
                to_col += per_col
            else:
                row += step_row
                to_row += per_row
        if hit[i]:
            verdict[end_row, end_col] = 1
        elif verdict[end_row, end_col] == 0:
            verdict[end_row, end_col] = -1
