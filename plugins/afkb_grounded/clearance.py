"""Clearance and proximity: what is free above a thing, and how far it is to others."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_grounded.seen import BODY, SURFACE, UPRIGHT, Seen
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import kth_smallest

FARTHEST_M = 3.0
"""No clearance is told beyond this: a view shows too little of a room."""
CELL_M = 0.05
PIXEL_STEP = 4
LEAST_ABOVE_M = 0.05
"""What is nearer to a top belongs to it: cloths, and the sensor's noise."""
BLOCKED_SHARE = 1 / 3
"""A top is as free as the lowest thing over more than this share of it lets it be: a back rest or
a cup blocks less, a table that a chair is pushed under blocks more."""
FEW = 24
"""Points of an outline that distances are taken from."""
_SPREAD = np.arange(FEW)
FRONT = math.cos(math.radians(45))


def add_clearances(things: Sequence[Seen], measures: list[dict[str, float]], view: View) -> None:
    """Add, to the measures of each surface and body, what is free above it and round it."""
    solid = [i for i, thing in enumerate(things) if {BODY, SURFACE} & set(thing.kinds)]
    standing = [i for i in solid if measures[i]]
    if view.depth_m is None or not standing:
        return
    T = view.T_map_camera
    cells = _cells(view.depth_m, intrinsics_of(view), T, PIXEL_STEP, CELL_M)
    for i in standing:
        top = measures[i]["top_height_m"]
        outline = np.ascontiguousarray(things[i].first.footprint_xy, np.float64)
        measures[i]["clearance_above_m"] = _free_above(*cells, outline, top, CELL_M)
    _add_distances([things[i] for i in standing], [measures[i] for i in standing], things, T)


@kernel
def _cells(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
    step: int,
    cell_m: float,
) -> tuple[NDArray[np.float32], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Heights of every step-th pixel's point, square by square, and where each square begins.

    Also the lowest square (2,) and how many squares they span (2,), seen from above.
    """
    fx, fy, cx, cy = intrinsics
    rows, cols = depth_m.shape
    most = ((rows + step - 1) // step) * ((cols + step - 1) // step)
    heights, ij = np.empty(most, np.float32), np.empty((most, 2), np.int64)
    low = np.full(2, np.int64(1 << 40))
    high = np.full(2, np.int64(-(1 << 40)))
    n = 0
    for v in range(0, rows, step):
        for u in range(0, cols, step):
            z = depth_m[v, u]
            if not 0 < z < 12.0:
                continue
            x, y = (u - cx) / fx, (v - cy) / fy
            for k in range(2):
                at = (T[k, 0] * x + T[k, 1] * y + T[k, 2]) * z + T[k, 3]
                ij[n, k] = math.floor(at / cell_m)
                low[k], high[k] = min(low[k], ij[n, k]), max(high[k], ij[n, k])
            heights[n] = (T[2, 0] * x + T[2, 1] * y + T[2, 2]) * z + T[2, 3]
            n += 1
    if n == 0:
        return heights[:0], np.zeros(1, np.int64), np.zeros(2, np.int64), np.zeros(2, np.int64)
    span = high - low + 1
    starts = np.zeros(span[0] * span[1] + 1, np.int64)
    for i in range(n):
        starts[(ij[i, 0] - low[0]) * span[1] + ij[i, 1] - low[1] + 1] += 1
    for k in range(len(starts) - 1):
        starts[k + 1] += starts[k]
    fill, sorted_ = starts[:-1].copy(), np.empty(n, np.float32)
    for i in range(n):
        k = (ij[i, 0] - low[0]) * span[1] + ij[i, 1] - low[1]
        sorted_[fill[k]] = heights[i]
        fill[k] += 1
    return sorted_, starts, low, span


@kernel
def _free_above(
    heights: NDArray[np.float32],
    starts: NDArray[np.int64],
    low: NDArray[np.int64],
    span: NDArray[np.int64],
    outline_xy: NDArray[np.float64],
    top_m: float,
    cell_m: float,
) -> float:
    """Height above a top that is free over all but a share of the squares it covers, m."""
    seen = np.zeros(max(span[0] * span[1], 1), np.bool_)
    free = np.empty(len(outline_xy))
    n = 0
    for m in range(len(outline_xy)):
        i = np.int64(math.floor(outline_xy[m, 0] / cell_m)) - low[0]
        j = np.int64(math.floor(outline_xy[m, 1] / cell_m)) - low[1]
        if not (0 <= i < span[0] and 0 <= j < span[1]) or seen[i * span[1] + j]:
            continue
        seen[i * span[1] + j] = True
        lowest = FARTHEST_M
        for k in range(starts[i * span[1] + j], starts[i * span[1] + j + 1]):
            over = heights[k] - top_m
            if over > LEAST_ABOVE_M:
                lowest = min(lowest, over)
        free[n] = lowest
        n += 1
    if n == 0:
        return FARTHEST_M
    return kth_smallest(free[:n], min(int(BLOCKED_SHARE * n), n - 1))


def _few(points_xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """FEW points spread over an outline; a short one is repeated."""
    return points_xy[_SPREAD * (len(points_xy) - 1) // (FEW - 1)]


def _add_distances(
    standing: Sequence[Seen],
    measures: Sequence[dict[str, float]],
    things: Sequence[Seen],
    T_map_camera: NDArray[np.float64],
) -> None:
    outlines = np.array([_few(thing.first.footprint_xy) for thing in standing])
    walls = [t.first.segment_xy for t in things if UPRIGHT in t.kinds]
    segments = np.array([w for w in walls if w is not None]).reshape(-1, 2, 2)
    spans = np.array([(m.get("bottom_height_m", m["top_height_m"]), m["top_height_m"])
                      for m in measures])  # fmt: skip
    is_body = np.array([BODY in thing.kinds for thing in standing])
    found = _distances(outlines, spans, is_body, segments, T_map_camera[:2, 3].copy())
    for (wall, side, front), own, body in zip(found.tolist(), measures, is_body, strict=True):
        own["to_wall_m"], own["clearance_front_m"] = wall, front
        if body:
            own["to_neighbour_m"], own["clearance_side_m"] = side, min(side, wall)


@kernel
def _distances(
    outlines: NDArray[np.float64],
    spans: NDArray[np.float64],
    is_body: NDArray[np.bool_],
    segments: NDArray[np.float64],
    camera_xy: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Of each outline (n, FEW, 2): distance to a wall, to a body of its height, to what is before.

    `spans` (n, 2): heights of its bottom and top. What is before it reaches above its top, within
    FRONT of the way to the camera.
    """
    n = len(outlines)
    found = np.full((n, 3), FARTHEST_M)
    middles, reach = np.zeros((n, 2)), np.zeros(n)
    for i in range(n):
        for p in outlines[i]:
            middles[i] += p / len(outlines[i])
        for p in outlines[i]:
            reach[i] = max(reach[i], math.hypot(p[0] - middles[i, 0], p[1] - middles[i, 1]))
    for i in range(n):
        for p in outlines[i]:
            for s in segments:
                found[i, 0] = min(found[i, 0], _to_segment(p, s[0], s[1]))
        to_camera = camera_xy - middles[i]
        far = max(math.hypot(to_camera[0], to_camera[1]), 1e-6)
        for j in range(n):
            away = middles[j] - middles[i]
            apart = math.hypot(away[0], away[1])
            if i == j or apart - reach[i] - reach[j] > FARTHEST_M:
                continue
            level = spans[j, 1] > spans[i, 0] + 0.01 and spans[j, 0] < spans[i, 1] - 0.01
            before = away @ to_camera > FRONT * far * apart and spans[j, 1] > spans[i, 1] + 0.01
            if not ((is_body[j] and level) or before):
                continue
            least = FARTHEST_M
            for p in outlines[i]:
                for q in outlines[j]:
                    least = min(least, math.hypot(p[0] - q[0], p[1] - q[1]))
            if is_body[j] and level:
                found[i, 1] = min(found[i, 1], least)
            if before:
                found[i, 2] = min(found[i, 2], least)
    return found


@kernel
def _to_segment(p: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Distance of a point (2,) from a segment, m."""
    wx, wy = b[0] - a[0], b[1] - a[1]
    share = ((p[0] - a[0]) * wx + (p[1] - a[1]) * wy) / max(wx * wx + wy * wy, 1e-12)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(p[0] - a[0] - share * wx, p[1] - a[1] - share * wy)
