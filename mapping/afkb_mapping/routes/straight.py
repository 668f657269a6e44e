"""Straight lines over cells: exactly which cells they cross, and paths made of few of them."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.routes.drivable import Drivable

Array = NDArray[np.float64]

RESAMPLED_M = 0.25
"""Corners of a path are sought among points this far apart: half a robot's width."""
TOUCH_M = 1e-6
"""A cell that a line is in for less is touched by rounding alone."""
PULLS = 4
"""An even number: from either end in turn."""
SLACK = 1.0 + 1e-6


def cells_on(where: Drivable, start_xy: Array, end_xy: Array) -> tuple[NDArray[np.intp], Array]:
    """Cells (N, 2), row and column, that a line between two points (2,), m, is in; metres in each.

    Cut at every border between cells that it passes, so that none is left out.
    """
    a = (start_xy - where.origin_xy) / where.resolution_m
    b = (end_xy - where.origin_xy) / where.resolution_m
    cuts = [np.array([0.0, 1.0])]
    for k in range(2):
        if a[k] != b[k]:
            low, high = sorted((a[k], b[k]))
            cuts.append((np.arange(np.ceil(low), np.floor(high) + 1) - a[k]) / (b[k] - a[k]))
    shares = np.unique(np.clip(np.concatenate(cuts), 0.0, 1.0))
    metres = np.diff(shares) * float(np.linalg.norm(end_xy - start_xy))
    if not (metres > TOUCH_M).any():
        return np.floor(a[None, ::-1]).astype(np.intp), np.zeros(1)
    middles = a + ((shares[1:] + shares[:-1]) / 2)[:, None] * (b - a)
    crossed = metres > TOUCH_M
    return np.floor(middles[crossed][:, ::-1]).astype(np.intp), metres[crossed]


def cost_of(where: Drivable, start_xy: Array, end_xy: Array) -> float:
    """What driving straight from one point (2,), m, to another counts as, m; inf where it can't."""
    cells, metres = cells_on(where, start_xy, end_xy)
    rows, cols = cells.T
    inside = (rows >= 0) & (rows < where.free.shape[0]) & (cols >= 0) & (cols < where.free.shape[1])
    if not inside.all() or not where.free[rows, cols].all():
        return float("inf")
    return float(where.weight[rows, cols] @ metres)


def shortened(where: Drivable, points_xy: Array) -> Array:
    """The corners (M, 2) of a path through free cells (N, 2), m, pulled tight.

    A straight line takes the place of a part where all of its cells are free and it counts no more.
    """
    path = _pulled(where, _corners(points_xy))
    # Pulled from one end only, what lies beyond a narrow place stays slack.
    for _ in range(PULLS):
        path = _pulled(where, _resampled(path))[::-1]
    return path


def length_of(points_xy: Array) -> float:
    """Length of a path (N, 2), m."""
    return float(np.linalg.norm(np.diff(points_xy, axis=0), axis=1).sum())


def _pulled(where: Drivable, points: Array) -> Array:
    steps = [cost_of(where, a, b) for a, b in pairwise(points)]
    kept, at = [0], 0
    while at < len(points) - 1:
        for to in range(len(points) - 1, at, -1):
            if to == at + 1:
                break
            direct = cost_of(where, points[at], points[to])
            if math.isfinite(direct) and direct <= sum(steps[at:to]) * SLACK:
                break
        kept.append(to)
        at = to
    pulled: Array = points[kept]
    return pulled


def _corners(points_xy: Array) -> Array:
    """The ends of a path and where it turns."""
    if len(points_xy) < 3:
        return points_xy
    steps = np.diff(points_xy, axis=0)
    cross = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    keep = np.concatenate([[True], np.abs(cross) > 1e-9, [True]])
    corners: Array = points_xy[keep]
    return corners


def _resampled(points_xy: Array) -> Array:
    """The path with points no further apart than `RESAMPLED_M`."""
    parts = [points_xy[:1]]
    for a, b in pairwise(points_xy):
        n = max(1, int(np.ceil(np.linalg.norm(b - a) / RESAMPLED_M)))
        parts.append(a + (np.arange(1, n + 1) / n)[:, None] * (b - a))
    return np.concatenate(parts)
