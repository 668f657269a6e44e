"""Moments of small cells of a depth image: one pass over its pixels, all that cells need of them.

A plane is linear in inverse depth, and inverse depth has nearly constant noise, so a plane is an
unweighted least-squares fit of w = 1/z to pixel coordinates, and moments are enough for it. Loops
run along rows over one to four arrays each, so that the compiler makes vector code of them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

CELL = 4
"""Pixels along a cell."""

N, SU, SV, SUU, SUV, SVV, SW, SUW, SVW, SWW = range(10)
"""Moments of a cell: number of pixels with depth, and sums over these; u and v from its middle."""

N_SCRATCH = 11
"""Rows of pixels that `moments_of_row` works with."""

ZERO, ONE = np.float32(0.0), np.float32(1.0)
INNER, OUTER = np.float32(0.5), np.float32(1.5)
"""Distance of a cell's inner and outer pixels from its middle, px."""
INNER_SQUARED, OUTER_SQUARED = np.float32(0.25), np.float32(2.25)


@kernel
def moments_of_row(
    depth_m: NDArray[np.float32], r: int, scratch: NDArray[np.float32], m: NDArray[np.float32]
) -> None:
    """Write the moments of row r of the cells of a depth image (H, W) into m (10, cols + 2).

    In m and px. The first and the last column, a margin of empty cells, stay as they are.
    `scratch`: (N_SCRATCH, CELL * cols) of any content.
    """
    w, seen, sums = scratch[:4], scratch[4:8], scratch[8:11]
    for i in range(CELL):
        _invert(depth_m[r * CELL + i], w[i], seen[i])
    _add_down(seen[0], seen[1], seen[2], seen[3], sums)
    _add_across(sums[0], m[N])
    _lean_across(sums[0], m[SU])
    _spread_across(sums[0], m[SUU])
    _add_across(sums[1], m[SV])
    _lean_across(sums[1], m[SUV])
    _add_across(sums[2], m[SVV])
    _add_down(w[0], w[1], w[2], w[3], sums)
    _add_across(sums[0], m[SW])
    _lean_across(sums[0], m[SUW])
    _add_across(sums[1], m[SVW])
    _add_squares_down(w[0], w[1], w[2], w[3], sums[0])
    _add_across(sums[0], m[SWW])


@kernel
def _invert(z: NDArray[np.float32], w: NDArray[np.float32], seen: NDArray[np.float32]) -> None:
    """1/z of a row of pixels and 1, or 0 and 0 where there is no depth."""
    for u in range(len(w)):
        w[u] = ONE / z[u] if z[u] > ZERO else ZERO
    for u in range(len(w)):
        seen[u] = ONE if w[u] > ZERO else ZERO


@kernel
def _add_down(
    a: NDArray[np.float32],
    b: NDArray[np.float32],
    c: NDArray[np.float32],
    d: NDArray[np.float32],
    sums: NDArray[np.float32],
) -> None:
    """Of four rows, column by column: sum, sum times v, sum times v squared."""
    total, lean, spread = sums[0], sums[1], sums[2]
    for u in range(len(total)):
        total[u] = a[u] + b[u] + c[u] + d[u]
    for u in range(len(total)):
        lean[u] = OUTER * (d[u] - a[u]) + INNER * (c[u] - b[u])
    for u in range(len(total)):
        spread[u] = OUTER_SQUARED * (d[u] + a[u]) + INNER_SQUARED * (c[u] + b[u])


@kernel
def _add_squares_down(
    a: NDArray[np.float32],
    b: NDArray[np.float32],
    c: NDArray[np.float32],
    d: NDArray[np.float32],
    out: NDArray[np.float32],
) -> None:
    """Of four rows, column by column, the sum of squares."""
    for u in range(len(out)):
        out[u] = a[u] * a[u] + b[u] * b[u] + c[u] * c[u] + d[u] * d[u]


@kernel
def _add_across(x: NDArray[np.float32], out: NDArray[np.float32]) -> None:
    """Sum of each cell's four columns."""
    for c in range(len(x) // 4):
        out[c + 1] = x[4 * c] + x[4 * c + 1] + x[4 * c + 2] + x[4 * c + 3]


@kernel
def _lean_across(x: NDArray[np.float32], out: NDArray[np.float32]) -> None:
    """Sum of each cell's four columns times u."""
    for c in range(len(x) // 4):
        out[c + 1] = OUTER * (x[4 * c + 3] - x[4 * c]) + INNER * (x[4 * c + 2] - x[4 * c + 1])


@kernel
def _spread_across(x: NDArray[np.float32], out: NDArray[np.float32]) -> None:
    """Sum of each cell's four columns times u squared."""
    for c in range(len(x) // 4):
        outer, inner = x[4 * c + 3] + x[4 * c], x[4 * c + 2] + x[4 * c + 1]
        out[c + 1] = OUTER_SQUARED * outer + INNER_SQUARED * inner
