"""Things off every support: on one that is out of sight (paper Fig. 2, row 1), or on the floor."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_containers.above import FLOOR_M
from afkb_containers.clusters import Cluster
from afkb_containers.scene import Scene
from afkb_containers.stand import Stand
from afkb_mapping.image_regions import extent, order_by_label
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentiles
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


@kernel
def _seen_from_above(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    labels: NDArray[np.int16],
    camera_xy: NDArray[np.float64],
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8]]:
    """Pixels off every support and wall, between two heights, within range.

    Returns their columns and rows, the grid square of each (flat index), and the grid.
    """
    rows, cols = depth_m.shape
    side = int(2 * FARTHEST_M / CELL_M) + 3
    grid = np.zeros((side, side), np.uint8)
    us, vs = np.empty(rows * cols, np.int32), np.empty(rows * cols, np.int32)
    square = np.empty(rows * cols, np.int32)
    n = 0
    for v in range(rows):
        for u in range(cols):
            if labels[v, u] != 0 or depth_m[v, u] <= 0:
                continue
            h = points[v, u, 2]
            if not (low_m < h < high_m):
                continue
            dx, dy = points[v, u, 0] - camera_xy[0], points[v, u, 1] - camera_xy[1]
            if dx * dx + dy * dy > FARTHEST_M * FARTHEST_M:
                continue
            i, j = int((dx + FARTHEST_M) / CELL_M), int((dy + FARTHEST_M) / CELL_M)
            grid[i, j] = 1
            us[n], vs[n], square[n] = u, v, i * side + j
            n += 1
    return us[:n], vs[:n], square[:n], grid


@kernel
def _hidden_below(
    u: NDArray[np.int32], v: NDArray[np.int32], depth_m: NDArray[np.float32], u0: int, u1: int
) -> float:
    """Share of a thing's image columns below which something clearly nearer stands."""
    rows = depth_m.shape[0]
    lowest = np.full(u1 - u0, -1)
    for k in range(len(u)):
        lowest[u[k] - u0] = max(lowest[u[k] - u0], v[k])
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
    for u, v in _apart_from_above(scene, NEAREST_FLOOR_M, HIGHEST_M, min_pixels):
        depths, xyz = scene.at(u, v)
        low, high = percentiles(xyz[:, 2], 0.0, 100.0)
        u0, _, u1, _ = extent(u, v)
        if high - low > TALLEST_M or _hidden_below(u, v, scene.depth_m, u0, u1) < HIDDEN_SHARE:
            continue
        yield Cluster(u, v, depths, xyz, scene.depth_m.shape, Stand.HIDDEN, None)


def things_on_the_floor(scene: Scene, min_pixels: int) -> Iterator[Cluster]:
    """Compact bodies that stand apart on the floor, as bins and baskets do."""
    for u, v in _apart_from_above(scene, FLOOR_M, BIN_M[1] + 0.1, min_pixels):
        depths, xyz = scene.at(u, v)
        _, top = percentiles(xyz[:, 2], 0.0, 98.0)
        if BIN_M[0] < top < BIN_M[1]:
            yield Cluster(u, v, depths, xyz, scene.depth_m.shape, Stand.ON_FLOOR, 0.0)


def _apart_from_above(
    scene: Scene, low_m: float, high_m: float, min_pixels: int
) -> Iterator[tuple[NDArray[np.int32], NDArray[np.int32]]]:
    """Pixels (u, v) of what is narrow enough and alone, seen from above."""
    u, v, square, grid = _seen_from_above(
        scene.depth_m, scene.points, scene.labels, scene.camera_xyz[:2].copy(), low_m, high_m
    )
    if len(u) < min_pixels:
        return
    count, parts, stats, _ = cv2.connectedComponentsWithStats(
        cv2.dilate(grid, np.ones((2, 2), np.uint8)), connectivity=8
    )
    wide = np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) * CELL_M
    of = parts.ravel()[square]
    narrow = (wide <= WIDEST_M) & (np.bincount(of, minlength=count) >= min_pixels)
    narrow[0] = False
    order, starts = order_by_label(of, narrow)
    for k in np.flatnonzero(narrow):
        member = order[starts[k] : starts[k + 1]]
        yield u[member], v[member]
