"""Where surfaces meet in a valley: the concave edges at which one body ends and another begins.

Bodies that touch meet in concave edges, while the edges of one simple body are convex (Stein et
al., Object Partitioning using Local Convexity, CVPR 2014). The inverse of depth is linear over the
image of any plane, so that its second difference is free of slant: it is positive in a valley.
The pixels here are cells, see `cells.py`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_things.cells import step

ARM_M = 0.010
"""Half of the width over which an edge is looked for, m, where noise doesn't ask for more."""
ARM_SIGMAS = 5.6
STEEPNESS = 0.22
"""Depth of a valley over its arm: two faces that turn towards each other by 25 degrees."""
STEEPEST = 4.0
"""A surface that falls away faster per arm is another one: the sight line grazes it."""
LEAST_ARM_PX, MOST_ARM_PX = 2, 20
SMOOTHED = 1
"""Means are over squares of this many pixels to either side."""
DIRECTIONS = ((0, 1), (1, 0), (1, 1), (1, -1))


@kernel
def valleys(
    depth_m: NDArray[np.float32],
    focal_px: float,
    noise: float,
) -> NDArray[np.float32]:
    """How deep a valley each pixel lies in: (H, W), 1 where it is an edge, below 0 on ridges.

    `depth_m` (H, W) is 0 where nothing of what stands together is seen.
    """
    rows, cols = depth_m.shape
    means = _inverse_means(depth_m, noise)
    out = np.zeros(depth_m.shape, np.float32)
    for v in range(rows):
        for u in range(cols):
            here = means[v, u]
            if here <= 0:
                continue
            z = 1.0 / here
            arm = max(ARM_M, ARM_SIGMAS * noise * depth_sigma(z))
            px = int(min(max(round(arm * focal_px / z), LEAST_ARM_PX), MOST_ARM_PX))
            arm = px * z / focal_px
            deepest = -1e9
            for dv, du in DIRECTIONS:
                far = arm * (math.sqrt(2.0) if du != 0 and dv != 0 else 1.0)
                rise = _second_difference(means, u, v, du * px, dv * px, far)
                deepest = max(deepest, rise * z * z / (STEEPNESS * far))
            out[v, u] = deepest if deepest > -1e8 else 0.0
    return out


@kernel
def _second_difference(
    means: NDArray[np.float32],
    u: int,
    v: int,
    du: int,
    dv: int,
    arm_m: float,
) -> float:
    """Mean of two means to either side less that in the middle, 1/m; -1e9 where one is lost."""
    rows, cols = means.shape
    a, b = u + du, v + dv
    c, d = u - du, v - dv
    if min(a, c) < 0 or max(a, c) >= cols or min(b, d) < 0 or max(b, d) >= rows:
        return -1e9
    first, second, here = means[b, a], means[d, c], means[v, u]
    if first <= 0 or second <= 0:
        return -1e9
    if max(abs(1.0 / first - 1.0 / here), abs(1.0 / second - 1.0 / here)) > STEEPEST * arm_m:
        return -1e9
    return 0.5 * (first + second) - here


@kernel
def _inverse_means(depth_m: NDArray[np.float32], noise: float) -> NDArray[np.float32]:
    """Mean inverse depth (H, W) of each pixel's square, 1/m; 0 where there is none."""
    rows, cols = depth_m.shape
    out = np.zeros(depth_m.shape, np.float32)
    for v in range(rows):
        for u in range(cols):
            z = depth_m[v, u]
            if z <= 0:
                continue
            near = step(z, noise)
            total, count = 0.0, 0
            for b in range(max(v - SMOOTHED, 0), min(v + SMOOTHED + 1, rows)):
                for a in range(max(u - SMOOTHED, 0), min(u + SMOOTHED + 1, cols)):
                    other = depth_m[b, a]
                    if other > 0 and abs(other - z) < near:
                        total, count = total + 1.0 / other, count + 1
            if count >= 2:
                out[v, u] = total / count
    return out
