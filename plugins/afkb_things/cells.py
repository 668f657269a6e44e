"""The pixels of what stands together, thinned to cells: what tells bodies apart is larger."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

STEP_M, STEP_SIGMAS = 0.015, 3.0
FOCAL_PX = 260.0
"""Focal length of a cell image: cells of two pixels where the camera has 525."""
LEAST_CELL_M = 0.004
"""What is so near that its cells would be smaller is looked at in larger ones."""
SURE = 0.3
"""A pixel whose depth is off from that of its own cell by so little of what is allowed is of it."""

Box = tuple[int, int, int, int]


def cell_size(focal_px: float, range_m: float = 0.0) -> int:
    """Pixels along a side of a cell, of what is so far away.

    >>> cell_size(525.0), cell_size(525.0, 2.0), cell_size(525.0, 0.4)
    (2, 2, 5)
    """
    least = max(1, round(focal_px / FOCAL_PX))
    return max(least, int(LEAST_CELL_M * focal_px / range_m)) if range_m > 0 else least


def cell_box(image_box: Box, shape: tuple[int, ...], size: int) -> Box:
    """The cells, half-open (u0, v0, u1, v1), that cover a box of an image of `shape`."""
    u0, v0, u1, v1 = image_box
    rows, cols = shape[0] // size, shape[1] // size
    return u0 // size, v0 // size, min(-(-u1 // size), cols), min(-(-v1 // size), rows)


@kernel
def cells_of(
    depth_m: NDArray[np.float32],
    pools: NDArray[np.int32],
    pool: int,
    kinds: NDArray[np.int16],
    size: int,
    box: Box,
    noise: float,
) -> tuple[NDArray[np.float32], NDArray[np.int16]]:
    """Depth and kind of the cells of a box (h, w), each of its first pixel that is of the pool.

    The depth is the mean of those pixels of that pool that lie about as deep; 0 where none is.
    """
    u0, v0, u1, v1 = box
    depths, kind = np.zeros((v1 - v0, u1 - u0), np.float32), np.zeros((v1 - v0, u1 - u0), np.int16)
    for i in range(v0, v1):
        for j in range(u0, u1):
            total, count, z = 0.0, 0, np.float32(0)
            near = 0.0
            for v in range(i * size, (i + 1) * size):
                for u in range(j * size, (j + 1) * size):
                    if pools[v, u] != pool or depth_m[v, u] <= 0:
                        continue
                    if count == 0:
                        z, kind[i - v0, j - u0] = depth_m[v, u], kinds[v, u]
                        near = step(z, noise)
                    elif abs(depth_m[v, u] - z) > near:
                        continue
                    total, count = total + depth_m[v, u], count + 1
            if count:
                depths[i - v0, j - u0] = total / count
    return depths, kind


@kernel
def step(z_m: float, noise: float) -> float:
    """Difference of depth, m, from which what lies z_m deep is another surface, or seen past."""
    return STEP_M + STEP_SIGMAS * noise * depth_sigma(z_m)


@kernel
def of_pixels(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    depths: NDArray[np.float32],
    patches: NDArray[np.int32],
    size: int,
    box: Box,
    noise: float,
) -> NDArray[np.int32]:
    """Patch of each pixel (N,) of a pool: of the cell near it that is most alike in depth.

    0 where none is; such a pixel hangs between a thing's edge and what is behind it.
    """
    out = np.zeros(len(u), np.int32)
    rows, cols = patches.shape
    for k in range(len(u)):
        i, j = min(v[k] // size - box[1], rows - 1), min(u[k] // size - box[0], cols - 1)
        z = depth_m[k]
        least = step(z, noise)
        if patches[i, j] > 0 and abs(depths[i, j] - z) < SURE * least:
            out[k] = patches[i, j]
            continue
        for r in range(max(i - 1, 0), min(i + 2, rows)):
            for c in range(max(j - 1, 0), min(j + 2, cols)):
                off = abs(depths[r, c] - z) * (1.0 if r == i and c == j else 1.5)
                if patches[r, c] > 0 and off < least:
                    least, out[k] = off, patches[r, c]
    return out
