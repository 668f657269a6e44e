"""How an upright plane stands out and falls back: a relief of it, from the depth image."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

UNKNOWN, FLAT, RAISED, SUNK, MISSING = range(5)
"""What a cell of a relief shows: nothing, the plane, what stands out of it, what is set back, and
what the sensor returns nothing for."""
PIXEL_STEP = 2
MOST_RAISED_M, MOST_SUNK_M = 0.16, 0.12
"""What stands out farther stands before the plane, what lies deeper behind is seen through it."""
LEAST_STEP_M = 0.008
NOISE_STEPS = 3.0
"""A cell's mean must be off by so many standard deviations of one depth, and by LEAST_STEP_M."""


@kernel
def relief_of(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
    image_box: NDArray[np.int64],
    start_xy: NDArray[np.float64],
    along_xy: NDArray[np.float64],
    bottom_m: float,
    shape: tuple[int, int],
    cell_m: float,
) -> tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.float32]]:
    """Kind, mean offset (m, towards the camera) and missing share of each cell, all `shape`.

    The plane is vertical, through `start_xy` along the unit vector `along_xy`; the cells begin
    there, at `bottom_m` above the floor: along first, up second. A pixel belongs to the cell in
    which its ray meets the plane, whether it returned something or not.
    """
    fx, fy, cx, cy = intrinsics
    nx, ny = along_xy[1], -along_xy[0]
    away = (T[0, 3] - start_xy[0]) * nx + (T[1, 3] - start_xy[1]) * ny
    if away < 0:
        nx, ny, away = -nx, -ny, -away
    n, missing = np.zeros(shape), np.zeros(shape)
    other = np.zeros(shape)
    sums = np.zeros(shape)
    tolerance = np.zeros(shape)
    u0, v0, u1, v1 = image_box
    ta, za = -(T[0, 0] * nx + T[1, 0] * ny) / fx, T[2, 0] / fx
    sa = (T[0, 0] * along_xy[0] + T[1, 0] * along_xy[1]) / fx
    eye_s = (T[0, 3] - start_xy[0]) * along_xy[0] + (T[1, 3] - start_xy[1]) * along_xy[1]
    eye_z = T[2, 3] - bottom_m
    for v in range(v0, v1, PIXEL_STEP):
        y = (v - cy) / fy
        dx, dy = T[0, 1] * y + T[0, 2], T[1, 1] * y + T[1, 2]
        tb, sb = -(dx * nx + dy * ny), dx * along_xy[0] + dy * along_xy[1]
        zb = T[2, 1] * y + T[2, 2]
        for u in range(u0, u1, PIXEL_STEP):
            x = u - cx
            toward = ta * x + tb
            if toward < 0.05:
                continue
            hit = away / toward
            i = math.floor((eye_s + hit * (sa * x + sb)) / cell_m)
            j = math.floor((eye_z + hit * (za * x + zb)) / cell_m)
            if not (0 <= i < shape[0] and 0 <= j < shape[1]):
                continue
            z = depth_m[v, u]
            if z <= 0:
                missing[i, j] += 1
                continue
            offset = away - z * toward
            if -MOST_SUNK_M <= offset <= MOST_RAISED_M:
                n[i, j] += 1
                sums[i, j] += offset
                tolerance[i, j] = max(LEAST_STEP_M, NOISE_STEPS * depth_sigma(z) * toward)
            else:
                other[i, j] += 1
    kinds = np.zeros(shape, np.uint8)
    offsets, lost = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    for i in range(shape[0]):
        for j in range(shape[1]):
            total = n[i, j] + missing[i, j] + other[i, j]
            if total == 0 or other[i, j] > 0.5 * total:
                continue
            lost[i, j] = missing[i, j] / total
            if n[i, j] == 0 or missing[i, j] > 0.5 * total:
                kinds[i, j] = MISSING
                continue
            offset = sums[i, j] / n[i, j]
            offsets[i, j] = offset
            if offset > tolerance[i, j]:
                kinds[i, j] = RAISED
            elif offset < -tolerance[i, j]:
                kinds[i, j] = SUNK
            else:
                kinds[i, j] = FLAT
    return kinds, offsets, lost


@kernel
def ring_flat_share(
    kinds: NDArray[np.uint8],
    labels: NDArray[np.int32],
    name: int,
    i0: int,
    j0: int,
    i1: int,
    j1: int,
) -> float:
    """Share of the cells right round a part's rectangle that show the plane; the floor counts."""
    flat = total = 0
    for i in range(i0 - 1, i1 + 1):
        for j in range(j0 - 1, j1 + 1):
            if i0 <= i < i1 and j0 <= j < j1:
                continue
            if j < 0:
                continue
            total += 1
            inside = 0 <= i < kinds.shape[0] and j < kinds.shape[1]
            flat += inside and kinds[i, j] == FLAT
    return flat / max(total, 1)


@kernel
def part_sums(
    labels: NDArray[np.int32],
    kinds: NDArray[np.uint8],
    offsets: NDArray[np.float32],
    lost: NDArray[np.float32],
    count: int,
) -> NDArray[np.float64]:
    """Of each part (count,): cells, those with depth, sums of offset, its square, missing share."""
    sums = np.zeros((count, 5))
    for i in range(labels.shape[0]):
        for j in range(labels.shape[1]):
            k = labels[i, j]
            sums[k, 0] += 1
            sums[k, 4] += lost[i, j]
            if kinds[i, j] != MISSING:
                sums[k, 1] += 1
                sums[k, 2] += offsets[i, j]
                sums[k, 3] += offsets[i, j] * offsets[i, j]
    return sums
