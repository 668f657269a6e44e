"""The pixels of what stands together, thinned to cells: what tells bodies apart is larger."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

FOCAL_PX = 260.0
"""Focal length of a cell image: cells of two pixels where the camera has 525."""


def cell_size(focal_px: float) -> int:
    """Pixels along a side of a cell."""
    return max(1, round(focal_px / FOCAL_PX))


@kernel
def cells_of(
    depth_m: NDArray[np.float32],
    pools: NDArray[np.int32],
    kinds: NDArray[np.int16],
    size: int,
    box: tuple[int, int, int, int],
) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.int16]]:
    """Depth, pool and kind of cells (H / size, W / size): of the first pixel of a pool in each.

    Outside of the box all are 0.
    The depth is the mean of those pixels of that pool that lie about as deep; 0 where none is.
    """
    rows, cols = pools.shape[0] // size, pools.shape[1] // size
    depths, of = np.zeros((rows, cols), np.float32), np.zeros((rows, cols), np.int32)
    kind = np.zeros((rows, cols), np.int16)
    u0, v0, u1, v1 = box
    for i in range(v0 // size, min(-(-v1 // size), rows)):
        for j in range(u0 // size, min(-(-u1 // size), cols)):
            total, count, z = 0.0, 0, np.float32(0)
            for v in range(i * size, (i + 1) * size):
                for u in range(j * size, (j + 1) * size):
                    if pools[v, u] <= 0 or depth_m[v, u] <= 0:
                        continue
                    if count == 0:
                        z, of[i, j], kind[i, j] = depth_m[v, u], pools[v, u], kinds[v, u]
                    elif pools[v, u] != of[i, j] or (
                        abs(depth_m[v, u] - z) > 0.015 + 3.0 * depth_sigma(z)
                    ):
                        continue
                    total, count = total + depth_m[v, u], count + 1
            if count:
                depths[i, j] = total / count
    return depths, of, kind


@kernel
def of_pixels(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    pool: int,
    pools: NDArray[np.int32],
    depths: NDArray[np.float32],
    patches: NDArray[np.int32],
    size: int,
) -> NDArray[np.int32]:
    """Patch of each pixel (N,) of a pool: of the cell near it that is most alike in depth.

    0 where none is; such a pixel hangs between a thing's edge and what is behind it.
    """
    out = np.zeros(len(u), np.int32)
    rows, cols = patches.shape
    for k in range(len(u)):
        i, j = min(v[k] // size, rows - 1), min(u[k] // size, cols - 1)
        z = depth_m[k]
        least = 0.015 + 3.0 * depth_sigma(z)
        for r in range(max(i - 1, 0), min(i + 2, rows)):
            for c in range(max(j - 1, 0), min(j + 2, cols)):
                off = abs(depths[r, c] - z) * (1.0 if r == i and c == j else 1.5)
                if pools[r, c] == pool and patches[r, c] > 0 and off < least:
                    least, out[k] = off, patches[r, c]
    return out
