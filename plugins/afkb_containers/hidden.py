"""Things off every support: on one that is out of sight (paper Fig. 2, row 1), or on the floor."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from afkb_containers.above import FLOOR_M
from afkb_containers.clusters import Cluster
from afkb_containers.scene import Scene
from afkb_containers.stand import Stand
from afkb_mapping.sensor_noise import depth_sigma

NEAREST_FLOOR_M = 0.25
HIGHEST_M = 1.8
FARTHEST_M = 3.5
"""Beyond this, noise hides an opening and makes one of what it isn't."""
CELL_M = 0.015
WIDEST_M = 0.75
TALLEST_M = 0.5
BIN_M = (0.15, 0.85)
"""Lowest and highest rim of what stands on the floor: bins, baskets, boxes."""
HIDDEN_SHARE = 0.6
"""Share of a thing's lower outline that something nearer must cover."""


@njit(cache=True)
def _seen_from_above(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    labels: NDArray[np.int16],
    camera_xy: NDArray[np.float64],
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.uint8]]:
    """Pixels off every support and wall, between two heights, within range.

    Returns their flat indexes, the grid square of each (flat index, too), and the grid.
    """
    rows, cols = depth_m.shape
    side = int(2 * FARTHEST_M / CELL_M) + 3
    grid = np.zeros((side, side), np.uint8)
    flat = np.empty(rows * cols, np.int64)
    square = np.empty(rows * cols, np.int32)
    n = 0
    for v in range(rows):
        for u in range(cols):
            if depth_m[v, u] <= 0 or labels[v, u] != 0:
                continue
            h = points[v, u, 2]
            dx, dy = points[v, u, 0] - camera_xy[0], points[v, u, 1] - camera_xy[1]
            if not (low_m < h < high_m) or dx * dx + dy * dy > FARTHEST_M * FARTHEST_M:
                continue
            i, j = int((dx + FARTHEST_M) / CELL_M), int((dy + FARTHEST_M) / CELL_M)
            grid[i, j] = 1
            flat[n] = v * cols + u
            square[n] = i * side + j
            n += 1
    return flat[:n], square[:n], grid


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


def things_on_hidden_supports(scene: Scene, min_pixels: int) -> Iterator[Cluster]:
    """Compact bodies that stand apart, seen from above, and whose foot something nearer covers."""
    depth_m = scene.depth_m
    for u, v, xyz in _apart_from_above(scene, NEAREST_FLOOR_M, HIGHEST_M, min_pixels):
        if np.ptp(xyz[:, 2]) > TALLEST_M:
            continue
        if _hidden_below(u, v, depth_m, int(u.min()), int(u.max()) + 1) >= HIDDEN_SHARE:
            yield Cluster(Stand.HIDDEN, u, v, depth_m[v, u], xyz, depth_m.shape, None)


def things_on_the_floor(scene: Scene, min_pixels: int) -> Iterator[Cluster]:
    """Compact bodies that stand apart on the floor, as bins and baskets do."""
    depth_m = scene.depth_m
    for u, v, xyz in _apart_from_above(scene, FLOOR_M, BIN_M[1] + 0.1, min_pixels):
        if BIN_M[0] < np.percentile(xyz[:, 2], 98) < BIN_M[1]:
            yield Cluster(Stand.ON_FLOOR, u, v, depth_m[v, u], xyz, depth_m.shape, 0.0)


def _apart_from_above(
    scene: Scene, low_m: float, high_m: float, min_pixels: int
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]]:
    """Pixels (u, v) and points (N, 3) of what is narrow enough and alone, seen from above."""
    flat, square, grid = _seen_from_above(
        scene.depth_m, scene.points, scene.labels, scene.camera_xyz[:2].copy(), low_m, high_m
    )
    if len(flat) < min_pixels:
        return
    count, parts, stats, _ = cv2.connectedComponentsWithStats(
        cv2.dilate(grid, np.ones((2, 2), np.uint8)), connectivity=8
    )
    wide = np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) * CELL_M
    of = parts.ravel()[square]
    pixels = np.bincount(of, minlength=count)
    narrow = (wide <= WIDEST_M) & (pixels >= min_pixels)
    narrow[0] = False
    kept = np.flatnonzero(narrow[of])
    kept = kept[np.argsort(of[kept], kind="stable")]
    for member in np.split(kept, np.cumsum(pixels[narrow])[:-1]) if len(kept) else []:
        v, u = np.divmod(flat[member], scene.depth_m.shape[1])
        yield u, v, scene.points[v, u].astype(np.float64)
