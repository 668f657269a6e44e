"""Smooth or convex patches of what stands together, and where they touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_things.cells import step

LEAST_PIXELS = 12
"""A smooth patch of fewer cells may be noise."""
EDGE = 1.0
"""Depth of a valley from which it parts two patches."""
NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0))
NONE = np.int64(0)
"""Of a type, as a literal is not: `_flood` is compiled once."""


@kernel
def patches_of(
    depth_m: NDArray[np.float32],
    kinds: NDArray[np.int16],
    valley: NDArray[np.float32],
    noise: float,
) -> tuple[NDArray[np.int32], int]:
    """Number the patches of a pool, from 1: (H, W), connected, of one kind, no valley; how many.

    What lies in a valley, or in a patch too small to tell, goes to the patch that reaches it first;
    where none does, it makes one. `depth_m` is 0 off the pool.
    """
    rows, cols = depth_m.shape
    out = np.zeros((rows, cols), np.int32)
    queue = np.empty((rows * cols, 2), np.int32)
    count, filled = 0, NONE
    for smooth in (True, False):
        for v in range(rows):
            for u in range(cols):
                if depth_m[v, u] <= 0 or out[v, u] != 0 or (smooth and valley[v, u] >= EDGE):
                    continue
                count += 1
                out[v, u] = count
                queue[filled, 0], queue[filled, 1] = v, u
                start = filled
                filled = _flood(depth_m, kinds, valley, noise, out, queue, start, start + 1, smooth)
                if smooth and filled - start < LEAST_PIXELS:
                    for k in range(start, filled):
                        out[queue[k, 0], queue[k, 1]] = -1
                    filled = start
                    count -= 1
        if smooth:
            for v in range(rows):
                for u in range(cols):
                    out[v, u] = max(out[v, u], 0)
            filled = _flood(depth_m, kinds, valley, noise, out, queue, NONE, filled, not smooth)
    return out, count


@kernel
def _flood(
    depth_m: NDArray[np.float32],
    kinds: NDArray[np.int16],
    valley: NDArray[np.float32],
    noise: float,
    out: NDArray[np.int32],
    queue: NDArray[np.int32],
    first: int,
    filled: int,
    smooth: bool,
) -> int:
    """Give the patches of queued pixels to neighbours on the same surface: smooth ones, or all."""
    rows, cols = depth_m.shape
    while first < filled:
        v, u = queue[first, 0], queue[first, 1]
        first += 1
        z, patch, kind = depth_m[v, u], out[v, u], kinds[v, u]
        jump = step(z, noise)
        for dv, du in NEIGHBOURS:
            b, a = v + dv, u + du
            # a lost pixel or two don't part a surface
            for _ in range(2):
                if 0 <= b < rows and 0 <= a < cols and depth_m[b, a] <= 0:
                    b, a = b + dv, a + du
            if not (0 <= b < rows and 0 <= a < cols) or out[b, a] != 0 or depth_m[b, a] <= 0:
                continue
            if abs(depth_m[b, a] - z) > jump:
                continue
            if smooth and (valley[b, a] >= EDGE or kinds[b, a] != kind):
                continue
            out[b, a] = patch
            queue[filled, 0], queue[filled, 1] = b, a
            filled += 1
    return filled


@kernel
def contacts(
    depth_m: NDArray[np.float32],
    patches: NDArray[np.int32],
    valley: NDArray[np.float32],
    count: int,
    noise: float,
    column: int,
) -> NDArray[np.float64]:
    """How the patches of a pool meet: (count + 1, count + 1, 5).

    Number of pixel pairs on one surface, the sum of the deeper one's valley over these (both
    symmetric), the number of pairs in which the first lies behind the second, and the first and
    the last column of all pairs, the first as a negative number. Columns count from `column` on.
    """
    rows, cols = depth_m.shape
    out = np.zeros((count + 1, count + 1, 5))
    out[..., 3:] = -1e9
    for v in range(rows):
        for u in range(cols):
            p, z = patches[v, u], depth_m[v, u]
            if p == 0:
                continue
            for dv, du in ((0, 1), (1, 0)):
                b, a = v + dv, u + du
                for _ in range(2):
                    if b < rows and a < cols and depth_m[b, a] <= 0:
                        b, a = b + dv, a + du
                if b >= rows or a >= cols or patches[b, a] == p or patches[b, a] == 0:
                    continue
                q, jump = patches[b, a], step(z, noise)
                for f, s in ((p, q), (q, p)):
                    out[f, s, 3], out[f, s, 4] = (
                        max(out[f, s, 3], -u - column),
                        max(out[f, s, 4], a + column),
                    )
                if depth_m[b, a] > z + jump:
                    out[q, p, 2] += 1
                elif depth_m[b, a] < z - jump:
                    out[p, q, 2] += 1
                else:
                    deep = max(valley[v, u], valley[b, a])
                    out[p, q, 0] += 1
                    out[q, p, 0] += 1
                    out[p, q, 1] += deep
                    out[q, p, 1] += deep
    return out
