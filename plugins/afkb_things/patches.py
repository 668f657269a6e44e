"""Smooth or convex patches of what stands together, and where they touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

Box = tuple[int, int, int, int]
LEAST_PIXELS = 12
"""A smooth patch of fewer cells may be noise."""
EDGE = 1.0
"""Depth of a valley from which it parts two patches."""
NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0))


@kernel
def patches_of(
    depth_m: NDArray[np.float32],
    pools: NDArray[np.int32],
    pool: int,
    kinds: NDArray[np.int16],
    valley: NDArray[np.float32],
    box: Box,
    out: NDArray[np.int32],
) -> int:
    """Number the patches of a pool in `out` (H, W), from 1: connected, of one kind, no valley.

    What lies in a valley, or in a patch too small to tell, goes to the patch that reaches it first;
    where none does, it makes one. Returns how many there are.
    """
    u0, v0, u1, v1 = box
    queue = np.empty(((u1 - u0) * (v1 - v0), 2), np.int32)
    count = filled = 0
    for smooth in (True, False):
        for v in range(v0, v1):
            for u in range(u0, u1):
                if pools[v, u] != pool or out[v, u] != 0 or (smooth and valley[v, u] >= EDGE):
                    continue
                count += 1
                first = start = filled
                out[v, u] = count
                queue[filled, 0], queue[filled, 1] = v, u
                filled += 1
                while first < filled:
                    filled = _spread(
                        depth_m, pools, kinds, valley, out, queue, first, filled, box, smooth
                    )
                    first += 1
                if smooth and filled - start < LEAST_PIXELS:
                    for k in range(start, filled):
                        out[queue[k, 0], queue[k, 1]] = -1
                    filled = start
                    count -= 1
        if smooth:
            for v in range(v0, v1):
                for u in range(u0, u1):
                    if pools[v, u] == pool and out[v, u] < 0:
                        out[v, u] = 0
            first = 0
            while first < filled:
                filled = _spread(
                    depth_m, pools, kinds, valley, out, queue, first, filled, box, False
                )
                first += 1
    return count


@kernel
def _spread(
    depth_m: NDArray[np.float32],
    pools: NDArray[np.int32],
    kinds: NDArray[np.int16],
    valley: NDArray[np.float32],
    out: NDArray[np.int32],
    queue: NDArray[np.int32],
    first: int,
    filled: int,
    box: Box,
    smooth: bool,
) -> int:
    """Give a pixel's patch to its neighbours on the same surface: smooth ones, or valleys."""
    u0, v0, u1, v1 = box
    v, u = queue[first, 0], queue[first, 1]
    z = depth_m[v, u]
    jump = 0.015 + 3.0 * depth_sigma(z)
    for dv, du in NEIGHBOURS:
        b, a = v + dv, u + du
        # a lost pixel or two don't part a surface
        for _ in range(2):
            if v0 <= b < v1 and u0 <= a < u1 and depth_m[b, a] <= 0:
                b, a = b + dv, a + du
        if not (v0 <= b < v1 and u0 <= a < u1) or out[b, a] != 0 or pools[b, a] != pools[v, u]:
            continue
        if abs(depth_m[b, a] - z) > jump:
            continue
        if smooth and (valley[b, a] >= EDGE or kinds[b, a] != kinds[v, u]):
            continue
        out[b, a] = out[v, u]
        queue[filled, 0], queue[filled, 1] = b, a
        filled += 1
    return filled


@kernel
def contacts(
    depth_m: NDArray[np.float32],
    pools: NDArray[np.int32],
    pool: int,
    patches: NDArray[np.int32],
    valley: NDArray[np.float32],
    count: int,
    box: Box,
) -> NDArray[np.float64]:
    """How the patches of a pool meet: (count + 1, count + 1, 5).

    Number of pixel pairs on one surface, the sum of the deeper one's valley over these (both
    symmetric), the number of pairs in which the first lies behind the second, and the first and
    the last column of all pairs, the first as a negative number.
    """
    u0, v0, u1, v1 = box
    out = np.zeros((count + 1, count + 1, 5))
    out[..., 3:] = -1e9
    for v in range(v0, v1):
        for u in range(u0, u1):
            if pools[v, u] != pool:
                continue
            p, z = patches[v, u], depth_m[v, u]
            jump = 0.015 + 3.0 * depth_sigma(z)
            for dv, du in ((0, 1), (1, 0)):
                b, a = v + dv, u + du
                for _ in range(2):
                    if b < v1 and a < u1 and depth_m[b, a] <= 0:
                        b, a = b + dv, a + du
                if b >= v1 or a >= u1 or pools[b, a] != pool or patches[b, a] == p:
                    continue
                q = patches[b, a]
                for f, s in ((p, q), (q, p)):
                    out[f, s, 3], out[f, s, 4] = max(out[f, s, 3], -u), max(out[f, s, 4], a)
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
