"""How far a surface reaches, seen from above: the grid squares whose middle the image shows."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

MAX_SQUARES = 400_000
"""A surface of more squares than this is seen from too far for them to mean anything."""
MIN_AROUND = 3
"""A square with fewer neighbours than this is a stray."""


@kernel
def footprint_of(
    labels: NDArray[np.int32],
    label: int,
    span: tuple[float, float, float, float],
    plane: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
    depth_m: NDArray[np.float32],
    of_cells: NDArray[np.int32],
) -> NDArray[np.float64]:
    """Centres (M, 2) of the squares whose middle lies on a pixel of the label, sorted, m.

    A pixel of `labels` (H, W) without depth, in `depth_m`, is of what the plane of its cell is of:
    `of_cells` (rows, cols).

    Rows of a distant, grazing surface fall several squares apart; going from the squares to the
    image, not the other way, leaves no gaps. `span`: x0, x1, y0, y1 where to look, m. `plane`:
    (3,), z = p0 x + p1 y + p2.
    """
    i0, j0 = math.floor(span[0] / step_m), math.floor(span[2] / step_m)
    ni, nj = math.floor(span[1] / step_m) - i0 + 1, math.floor(span[3] / step_m) - j0 + 1
    if ni * nj > MAX_SQUARES:
        return np.empty((0, 2))
    hit = np.zeros((ni + 2, nj + 2), np.bool_)
    T = T_map_camera
    fx, fy, cx, cy = intrinsics
    rows, cols = labels.shape
    size = max(cols // of_cells.shape[1], 1)
    y0 = (j0 + 0.5) * step_m
    # along a row of squares, all three camera coordinates grow by the same step
    step = np.empty(3)
    for k in range(3):
        step[k] = (T[1, k] + T[2, k] * plane[1]) * step_m
    at = np.empty(3)
    for i in range(ni):
        x = (i0 + i + 0.5) * step_m
        dx, dy, dz = x - T[0, 3], y0 - T[1, 3], plane[0] * x + plane[1] * y0 + plane[2] - T[2, 3]
        for k in range(3):
            at[k] = T[0, k] * dx + T[1, k] * dy + T[2, k] * dz
        for j in range(nj):
            depth = at[2] + j * step[2]
            if depth <= 0.1:
                continue
            near = 1.0 / depth
            u = (at[0] + j * step[0]) * near * fx + cx + 0.5
            v = (at[1] + j * step[1]) * near * fy + cy + 0.5
            if 0 <= u < cols and 0 <= v < rows:
                hit[i + 1, j + 1] = labels[int(v), int(u)] == label or (
                    not depth_m[int(v), int(u)] > 0
                    and of_cells[
                        min(int(v) // size, of_cells.shape[0] - 1),
                        min(int(u) // size, of_cells.shape[1] - 1),
                    ]
                    == label
                )
    return _centres(hit, i0, j0, step_m)


@kernel
def row_ends(footprint_xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """First and last square of each row of a sorted footprint (N, 2): its hull is theirs."""
    n = len(footprint_xy)
    out, count = np.empty((n, 2)), 0
    for k in range(n):
        x = footprint_xy[k, 0]
        if k == 0 or k == n - 1 or footprint_xy[k - 1, 0] != x or footprint_xy[k + 1, 0] != x:
            out[count] = footprint_xy[k]
            count += 1
    return out[:count].copy()


@kernel
def _centres(hit: NDArray[np.bool_], i0: int, j0: int, step_m: float) -> NDArray[np.float64]:
    """Centres of the squares that are hit, those without neighbours left out unless all are so."""
    kept, n = np.zeros(hit.shape, np.bool_), 0
    for i in range(1, hit.shape[0] - 1):
        for j in range(1, hit.shape[1] - 1):
            if hit[i, j] and _around(hit, i, j) >= MIN_AROUND:
                kept[i, j] = True
                n += 1
    if n == 0:
        kept = hit
        n = int(np.count_nonzero(hit))
    out = np.empty((n, 2))
    n = 0
    for i in range(1, hit.shape[0] - 1):
        for j in range(1, hit.shape[1] - 1):
            if kept[i, j]:
                out[n, 0], out[n, 1] = (i0 + i - 0.5) * step_m, (j0 + j - 0.5) * step_m
                n += 1
    return out


@kernel
def _around(hit: NDArray[np.bool_], i: int, j: int) -> int:
    count = -1
    for di in range(-1, 2):
        for dj in range(-1, 2):
            count += hit[i + di, j + dj]
    return count
