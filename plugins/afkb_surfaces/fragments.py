"""Parts of one support that something in front keeps apart in the image, joined again.

The paper's own example is a kitchen table hidden by what stands on it (Fig. 1b).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.image_regions import pixels_by_label
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.cells import CELL, DEPTH, X, Z
from afkb_surfaces.grouping import SUPPORT

SAMPLES = 48
SEEN_THROUGH = 2
"""Samples on the line between two parts that may show what lies behind the plane."""
PART_SAMPLES = 150
MIN_CELLS = 3


@kernel
def _seen_through(
    depth_m: NDArray[np.float32],
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    height_m: float,
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
) -> int:
    """Samples of the image line whose depth lies clearly behind the plane at height_m."""
    fx, fy, cx, cy = intrinsics
    count = 0
    for k in range(SAMPLES):
        t = (k + 0.5) / SAMPLES
        u, v = start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])
        z = depth_m[int(v), int(u)]
        if z <= 0:
            continue
        rise = T[2, 0] * (u - cx) / fx + T[2, 1] * (v - cy) / fy + T[2, 2]
        if rise * (height_m - T[2, 3]) <= 0:
            count += 1
            continue
        plane = (height_m - T[2, 3]) / rise
        if z > plane + 0.03 + 3.0 * depth_sigma(plane):
            count += 1
    return count


@kernel
def _closest(p: NDArray[np.float64], q: NDArray[np.float64]) -> tuple[float, int, int]:
    """Smallest squared distance between points (N, 2+) of two sets, and which these are."""
    best, bi, bj = np.inf, 0, 0
    for i in range(p.shape[0]):
        for j in range(q.shape[0]):
            d = (p[i, 0] - q[j, 0]) ** 2 + (p[i, 1] - q[j, 1]) ** 2
            if d < best:
                best, bi, bj = d, i, j
    return best, bi, bj


def join_fragments(
    depth_m: NDArray[np.float32],
    cells: NDArray[np.float64],
    labels: NDArray[np.int32],
    kinds: NDArray[np.int8],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
    gap_m: float,
) -> NDArray[np.int32]:
    """Labels (rows, cols) in which coplanar supports with only an occluder between them are one."""
    n = int(labels.max()) + 1
    wanted = np.zeros(n, np.bool_)
    wanted[labels[kinds == SUPPORT]] = True
    u, v, starts = pixels_by_label(labels, wanted, np.ones(n, np.int64))
    sizes = np.diff(starts)
    largest_first = np.argsort(-sizes, kind="stable")[: int((sizes >= MIN_CELLS).sum())]
    target = _joined(
        largest_first, u, v, starts, depth_m, cells, intrinsics, T_map_camera, step_m, gap_m
    )
    return target[labels]


@kernel
def _joined(
    largest_first: NDArray[np.int64],
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    starts: NDArray[np.int64],
    depth_m: NDArray[np.float32],
    cells: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
    gap_m: float,
) -> NDArray[np.int32]:
    """The label (n_labels,) that each joins: of the largest part that it goes with, or its own.

    Pixels (u, v) of label k begin at `starts[k]`.
    """
    target = np.arange(len(starts) - 1).astype(np.int32)
    heights, depths = np.zeros(len(target)), np.zeros(len(target))
    places = [np.zeros((0, 4))]
    for k in largest_first:
        part = slice(starts[k], starts[k + 1])
        heights[k], depths[k], place = _place_of(u[part], v[part], cells)
        places.append(place)
    for i in range(len(largest_first)):
        big = largest_first[i]
        for j in range(i + 1, len(largest_first)):
            small = largest_first[j]
            step = step_m + 0.4 * depth_sigma(depths[small])
            if target[small] != small or abs(heights[big] - heights[small]) > step:
                continue
            squared, m, n = _closest(places[i + 1], places[j + 1])
            if squared > gap_m * gap_m:
                continue
            start, end = places[i + 1][m, 2:], places[j + 1][n, 2:]
            behind = _seen_through(depth_m, start, end, heights[big], intrinsics, T_map_camera)
            if behind <= SEEN_THROUGH:
                target[small] = target[big]
    return target


@kernel
def _place_of(
    u: NDArray[np.int32], v: NDArray[np.int32], cells: NDArray[np.float64]
) -> tuple[float, float, NDArray[np.float64]]:
    """Median height and depth of cells, m, and a sample (N, 4) of their x, y and pixel u, v."""
    heights, depths = np.empty(len(u)), np.empty(len(u))
    for k in range(len(u)):
        heights[k], depths[k] = cells[v[k], u[k], Z], cells[v[k], u[k], DEPTH]
    thin = max(1, len(u) // PART_SAMPLES)
    place = np.empty(((len(u) + thin - 1) // thin, 4))
    for n in range(len(place)):
        i, j = v[n * thin], u[n * thin]
        place[n, 0], place[n, 1] = cells[i, j, X], cells[i, j, X + 1]
        place[n, 2], place[n, 3] = (j + 0.5) * CELL, (i + 0.5) * CELL
    return percentile(heights, 50.0), percentile(depths, 50.0), place
