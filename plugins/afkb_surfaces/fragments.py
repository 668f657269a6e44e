"""Parts of one support that something in front keeps apart in the image, joined again.

The paper's own example is a kitchen table hidden by what stands on it (Fig. 1b).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.cells import DEPTH, Cells, X, Y, Z

SAMPLES = 48
SEEN_THROUGH = 2
"""Samples on the line between two parts that may show what lies behind the plane."""
PART_SAMPLES = 240
MIN_CELLS = 3


@kernel
def _seen_through(
    depth_m: NDArray[np.float32],
    start: NDArray[np.float32],
    end: NDArray[np.float32],
    height_m: float,
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
    noise: float,
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
        if z > plane + 0.03 + 3.0 * noise * depth_sigma(plane):
            count += 1
    return count


@kernel
def _closest(p: NDArray[np.float32], q: NDArray[np.float32]) -> tuple[float, int, int]:
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
    cells: Cells,
    parts: tuple[NDArray[np.int64], NDArray[np.int64]],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
    gap_m: float,
) -> NDArray[np.int32]:
    """The label (n_labels,) that each joins: coplanar, with only an occluder between them.

    `parts`: flat indexes of the cells that may join, label by label, and where each label begins.
    """
    order, starts = parts
    sizes = np.diff(starts)
    return _joined(
        order,
        starts,
        np.argsort(-sizes, kind="stable")[: np.count_nonzero(sizes >= MIN_CELLS)],
        depth_m,
        cells.planes,
        cells.size_px,
        intrinsics,
        T_map_camera,
        step_m,
        gap_m,
        cells.noise,
    )


@kernel
def _joined(
    order: NDArray[np.int64],
    starts: NDArray[np.int64],
    parts: NDArray[np.int64],
    depth_m: NDArray[np.float32],
    planes: NDArray[np.float32],
    size_px: int,
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
    gap_m: float,
    noise: float,
) -> NDArray[np.int32]:
    """Each of the parts, largest first, takes in those smaller ones that go with it.

    Flat indexes of the cells of label k begin at `order[starts[k]]`.
    """
    target = np.arange(len(starts) - 1).astype(np.int32)
    heights, depths = np.zeros(len(parts)), np.zeros(len(parts))
    places = np.empty((len(parts), PART_SAMPLES, 4), np.float32)
    counts, boxes = np.zeros(len(parts), np.int64), np.empty((len(parts), 4), np.float32)
    for i in range(len(parts)):
        own = order[starts[parts[i]] : starts[parts[i] + 1]]
        heights[i], depths[i], counts[i] = _sample(own, planes, size_px, places[i])
        _box_of(places[i, : counts[i]], boxes[i])
    for i in range(len(parts)):
        big = places[i, : counts[i]]
        for j in range(i + 1, len(parts)):
            step = step_m + 0.4 * noise * depth_sigma(depths[j])
            if target[parts[j]] != parts[j] or abs(heights[i] - heights[j]) > step:
                continue
            if _apart(boxes[i], boxes[j]) > gap_m * gap_m:
                continue
            squared, m, n = _closest(big, places[j, : counts[j]])
            if squared > gap_m * gap_m:
                continue
            start, end = big[m, 2:], places[j, n, 2:]
            behind = _seen_through(depth_m, start, end, heights[i], intrinsics, T_map_camera, noise)
            if behind <= SEEN_THROUGH:
                target[parts[j]] = target[parts[i]]
    return target


@kernel
def _sample(
    own: NDArray[np.int64], planes: NDArray[np.float32], size_px: int, place: NDArray[np.float32]
) -> tuple[float, float, int]:
    """Median height and depth of cells, m; writes x, y and pixel u, v of some, and counts these."""
    cols, size = planes.shape[2], len(own)
    thin = (2 * size + PART_SAMPLES - 1) // PART_SAMPLES
    heights, depths = np.empty(PART_SAMPLES), np.empty(PART_SAMPLES)
    n = 0
    for k in range(size):
        # where a row of cells ends is where a gap begins
        ends = k == 0 or k == size - 1 or own[k - 1] != own[k] - 1 or own[k + 1] != own[k] + 1
        if n == PART_SAMPLES or not (ends or k % thin == 0):
            continue
        r, c = own[k] // cols, own[k] % cols
        heights[n], depths[n] = planes[r, Z, c], planes[r, DEPTH, c]
        place[n, 0], place[n, 1] = planes[r, X, c], planes[r, Y, c]
        place[n, 2], place[n, 3] = (c + 0.5) * size_px, (r + 0.5) * size_px
        n += 1
    return percentile(heights[:n], 50.0), percentile(depths[:n], 50.0), n


@kernel
def _box_of(place: NDArray[np.float32], box: NDArray[np.float32]) -> None:
    """Lowest and highest x and y of points."""
    box[0] = box[1] = place[0, 0]
    box[2] = box[3] = place[0, 1]
    for k in range(1, len(place)):
        box[0], box[1] = min(box[0], place[k, 0]), max(box[1], place[k, 0])
        box[2], box[3] = min(box[2], place[k, 1]), max(box[3], place[k, 1])


@kernel
def _apart(p: NDArray[np.float32], q: NDArray[np.float32]) -> float:
    """Squared distance of two boxes, m²."""
    dx = max(p[0] - q[1], q[0] - p[1], np.float32(0))
    dy = max(p[2] - q[3], q[2] - p[3], np.float32(0))
    return float(dx * dx + dy * dy)
