"""Parts of one support that something in front keeps apart in the image, joined again.

The paper's own example is a kitchen table hidden by what stands on it (Fig. 1b).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.cells import CELL, DEPTH, X, Z
from afkb_surfaces.grouping import SUPPORT

SAMPLES = 48
SEEN_THROUGH = 2
"""Samples on the line between two parts that may show what lies behind the plane."""


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
    """Smallest squared distance between two sets of points (N, 2), and the indexes of that pair."""
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
    min_cells: int = 3,
) -> NDArray[np.int32]:
    """Labels (rows, cols) in which coplanar supports with only an occluder between them are one."""
    rc = np.argwhere((kinds == SUPPORT) & (labels > 1))
    if len(rc) == 0:
        return labels
    of = labels[rc[:, 0], rc[:, 1]]
    order = np.argsort(of, kind="stable")
    rc, of = rc[order], of[order]
    names, starts = np.unique(of, return_index=True)
    parts = [
        _Part(int(n), group, cells)
        for n, group in zip(names, np.split(rc, starts[1:]), strict=True)
        if len(group) >= min_cells
    ]
    parts.sort(key=lambda p: (-len(p.rc), p.label))
    target = {p.label: p.label for p in parts}
    for i, big in enumerate(parts):
        for small in parts[i + 1 :]:
            if target[small.label] != small.label or abs(big.height - small.height) > (
                step_m + 0.4 * float(depth_sigma(small.depth))
            ):
                continue
            if big.sees_only_occluders_to(small, depth_m, intrinsics, T_map_camera, gap_m):
                target[small.label] = target[big.label]
    lookup = np.arange(int(labels.max()) + 1, dtype=np.int32)
    for source, to in target.items():
        lookup[source] = to
    return lookup[labels]


class _Part:
    """One connected support: its cells, their height and place."""

    def __init__(self, label: int, rc: NDArray[np.intp], cells: NDArray[np.float64]) -> None:
        self.label, self.rc = label, rc
        values = cells[rc[:, 0], rc[:, 1]]
        self.height = float(np.median(values[:, Z]))
        self.depth = float(np.median(values[:, DEPTH]))
        thin = max(1, len(rc) // 150)
        self.sample = rc[::thin]
        self.xy = np.ascontiguousarray(values[::thin, X : X + 2])

    def sees_only_occluders_to(
        self,
        other: _Part,
        depth_m: NDArray[np.float32],
        intrinsics: NDArray[np.float64],
        T_map_camera: NDArray[np.float64],
        gap_m: float,
    ) -> bool:
        squared, i, j = _closest(self.xy, other.xy)
        if squared > gap_m * gap_m:
            return False
        start = (self.sample[i][::-1] + 0.5) * CELL
        end = (other.sample[j][::-1] + 0.5) * CELL
        seen = _seen_through(depth_m, start, end, self.height, intrinsics, T_map_camera)
        return bool(seen <= SEEN_THROUGH)
