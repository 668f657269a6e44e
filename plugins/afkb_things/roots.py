"""Supports that are the tops, or the insides, of things on a larger support."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_things.supports import WALL_BIT

WITHIN = 0.8
"""Share of a support that must lie over a larger one, for it to be a thing's top."""
LARGER = 2.0
LEAST_RISE_M = 0.012


@kernel
def roots_of(
    heights_m: NDArray[np.float64],
    areas_m2: NDArray[np.float64],
    large: NDArray[np.bool_],
    raster: NDArray[np.uint64],
    highest_m: float,
) -> NDArray[np.int64]:
    """For each support, highest first, which support carries it at last; itself where none does.

    A small support over a larger one, no more than `highest_m` above it, is a thing's top.
    """
    n = len(heights_m)
    cells, both = np.zeros(n), np.zeros((n, n))
    for bits in raster.ravel():
        left = bits & ~(np.uint64(1) << WALL_BIT)
        if left & (left - np.uint64(1)) == 0 and left != 0:
            k = 0
            while not left & np.uint64(1):
                left >>= np.uint64(1)
                k += 1
            cells[k] += 1
        elif left != 0:
            for k in range(n):
                if left >> np.uint64(k) & np.uint64(1):
                    cells[k] += 1
                    for j in range(k + 1, n):
                        both[k, j] += np.float64(left >> np.uint64(j) & np.uint64(1))
    roots = np.arange(n)
    for k in range(n - 1, -1, -1):
        if large[k]:
            continue
        for j in range(k + 1, n):
            rise = heights_m[k] - heights_m[j]
            if not LEAST_RISE_M < rise < highest_m or areas_m2[j] < LARGER * areas_m2[k]:
                continue
            if both[k, j] >= WITHIN * cells[k]:
                roots[k] = roots[j]
                break
    return roots
