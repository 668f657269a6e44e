"""Things whose support is out of sight, behind what stands before it (paper Fig. 2, row 1)."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from afkb_containers.clusters import Cluster
from afkb_surfaces.noise import depth_sigma

NEAREST_FLOOR_M = 0.25
HIGHEST_M = 1.8
FARTHEST_M = 3.5
"""Beyond this, noise hides an opening and makes one of what it isn't."""
CELL_M = 0.015
WIDEST_M = 0.6
TALLEST_M = 0.5
HIDDEN_SHARE = 0.6
"""Share of a thing's lower outline that something nearer must cover."""


@njit(cache=True)
def _candidates(
    depth_m: NDArray[np.float32], points: NDArray[np.float32], labels: NDArray[np.int16]
) -> NDArray[np.int64]:
    """Flat indexes of pixels off every support, above seats' legs and within range."""
    rows, cols = depth_m.shape
    out = np.empty(rows * cols, np.int64)
    n = 0
    for v in range(rows):
        for u in range(cols):
            z = depth_m[v, u]
            h = points[v, u, 2]
            if 0 < z < FARTHEST_M and labels[v, u] == 0 and NEAREST_FLOOR_M < h < HIGHEST_M:
                out[n] = v * cols + u
                n += 1
    return out[:n]


@njit(cache=True)
def _hidden_below(
    u: NDArray[np.int64],
    v: NDArray[np.int64],
    depth_m: NDArray[np.float32],
    u0: int,
    u1: int,
) -> float:
    """Share of a thing's image columns below which something clearly nearer stands."""
    rows = depth_m.shape[0]
    lowest = np.full(u1 - u0, -1)
    index = np.zeros(u1 - u0, np.int64)
    for k in range(len(u)):
        if v[k] > lowest[u[k] - u0]:
            lowest[u[k] - u0] = v[k]
            index[u[k] - u0] = k
    hidden = total = 0
    for c in range(u1 - u0):
        if lowest[c] < 0:
            continue
        total += 1
        z = depth_m[lowest[c], u0 + c]
        for i in range(lowest[c] + 1, min(lowest[c] + 7, rows)):
            below = depth_m[i, u0 + c]
            if below > 0:
                hidden += below < z - 0.03 - 3.0 * depth_sigma(z)
                break
    return hidden / max(total, 1)


def things_on_hidden_supports(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    labels: NDArray[np.int16],
    min_pixels: int,
) -> Iterator[Cluster]:
    """Compact bodies that stand apart, seen from above, and whose foot something nearer covers."""
    flat = _candidates(depth_m, points, labels)
    if len(flat) < min_pixels:
        return
    xyz = points.reshape(-1, 3)[flat]
    ij = np.floor(xyz[:, :2] / CELL_M).astype(np.int32)
    ij -= ij.min(axis=0)
    grid = np.zeros(tuple((ij.max(axis=0) + 2).tolist()), np.uint8)
    grid[ij[:, 0], ij[:, 1]] = 1
    count, parts, stats, _ = cv2.connectedComponentsWithStats(
        cv2.dilate(grid, np.ones((2, 2), np.uint8)), connectivity=8
    )
    wide = np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) * CELL_M
    of = parts[ij[:, 0], ij[:, 1]]
    pixels = np.bincount(of, minlength=count)
    for k in np.flatnonzero((wide <= WIDEST_M) & (pixels >= min_pixels)):
        member = np.flatnonzero(of == k)
        if k == 0 or np.ptp(xyz[member, 2]) > TALLEST_M:
            continue
        v, u = np.divmod(flat[member], depth_m.shape[1])
        if _hidden_below(u, v, depth_m, int(u.min()), int(u.max()) + 1) >= HIDDEN_SHARE:
            shape = (depth_m.shape[0], depth_m.shape[1])
            yield Cluster(u, v, depth_m[v, u], xyz[member].astype(np.float64), shape, None)
