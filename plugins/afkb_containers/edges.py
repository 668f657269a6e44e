"""What the outline of a body borders on in the image, and which of its pixels are well inside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import ramp

FOOT_M = 0.025
"""Below this height over its base a body's outline meets what it stands on, or its shadow."""
STEP_M, STEP_SIGMAS = 0.015, 3.0
"""A step in depth that is no slope and no noise."""
MEAN_STEP_M = (0.008, 0.020)
"""The same of the mean of many smaller ones: none below the first, a step from the second on."""
SPECKLE_PX = 3
"""Beyond so many lost pixels the next one that returned is looked for."""
BEHIND, BEFORE, LEVEL, UNSEEN = 0, 1, 2, 3


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Shares of a body's outline above its foot, and the pixels (M,) away from all of it.

    - `free`: share, of where it can be told, of what ends before something farther. The rest goes
      on at the same depth, as a part of something larger does. What ends a few centimetres before
      a wall, which is less than noise, does so in the mean.
    - `hidden`: share of all where something nearer begins.
    """

    free: float
    hidden: float
    inner: NDArray[np.int64]


def edges_of(body: Body, depth_m: NDArray[np.float32], edge_px: int) -> Edges:
    """The edges of a body; its outermost edge_px pixels are not `inner`."""
    counts, step_m, inner = _edges(
        body.u, body.v, body.points[:, 2], depth_m, extent(body.u, body.v), edge_px,
        body.base_m + FOOT_M,
    )  # fmt: skip
    told, n = counts[BEHIND] + counts[LEVEL], counts.sum()
    free = counts[BEHIND] + counts[LEVEL] * ramp(step_m, MEAN_STEP_M)
    return Edges(free / told if told else 0.0, counts[BEFORE] / max(n, 1), inner)


@kernel
def _edges(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    heights_m: NDArray[np.float64],
    depth_m: NDArray[np.float32],
    box: tuple[int, int, int, int],
    edge_px: int,
    foot_m: float,
) -> tuple[NDArray[np.int64], float, NDArray[np.int64]]:
    """How often pixels above the foot border on each kind (4,); indexes of the inner pixels.

    And how much farther, in the mean, that is which seems level with them, m.
    """
    u0, v0, u1, v1 = box
    own = np.zeros((v1 - v0, u1 - u0), np.bool_)
    for k in range(len(u)):
        own[v[k] - v0, u[k] - u0] = True
    counts, steps = np.zeros(4, np.int64), 0.0
    inner, n = np.empty(len(u), np.int64), 0
    for k in range(len(u)):
        within = True
        for du, dv in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            borders = not _is_own(v[k] + dv - v0, u[k] + du - u0, own)
            if borders:
                i, j = _returned(v[k] + dv, u[k] + du, dv, du, depth_m)
                borders = not _is_own(i - v0, j - u0, own)
            if borders and heights_m[k] > foot_m:
                kind = _kind(i, j, depth_m[v[k], u[k]], depth_m)
                counts[kind] += 1
                if kind == LEVEL:
                    steps += depth_m[i, j] - depth_m[v[k], u[k]]
            if edge_px > 1 and not borders:
                i, j = _returned(v[k] + edge_px * dv, u[k] + edge_px * du, dv, du, depth_m)
                borders = not _is_own(i - v0, j - u0, own)
            within = within and not borders
        if within:
            inner[n] = k
            n += 1
    return counts, steps / max(counts[LEVEL], 1), inner[:n]


@kernel
def _is_own(i: int, j: int, own: NDArray[np.bool_]) -> bool:
    return bool(0 <= i < own.shape[0] and 0 <= j < own.shape[1] and own[i, j])


@kernel
def _returned(i: int, j: int, di: int, dj: int, depth_m: NDArray[np.float32]) -> tuple[int, int]:
    """The first pixel from here on that returned; the last looked at where none did."""
    rows, cols = depth_m.shape
    for _ in range(SPECKLE_PX):
        if not (0 <= i < rows and 0 <= j < cols) or depth_m[i, j] > 0:
            break
        i, j = i + di, j + dj
    return i, j


@kernel
def _kind(i: int, j: int, z_m: float, depth_m: NDArray[np.float32]) -> int:
    """What a pixel is to one of a body whose depth is z_m."""
    rows, cols = depth_m.shape
    if not (0 <= i < rows and 0 <= j < cols) or depth_m[i, j] <= 0:
        return UNSEEN
    step = STEP_M + STEP_SIGMAS * depth_sigma(z_m)
    if depth_m[i, j] > z_m + step:
        return BEHIND
    return BEFORE if depth_m[i, j] < z_m - step else LEVEL
