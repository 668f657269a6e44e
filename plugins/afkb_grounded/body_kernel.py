"""Shape of a body from its points, in one pass each: no primitive is needed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

SLICES = 10
"""Into how many slices a body is cut along its longest axis."""
LEAST_IN_SLICE = 4


@kernel
def principal(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Variances (3,) along the principal axes of points (N, 3), rising, and the axes as rows."""
    n = len(points)
    mean = np.zeros(3)
    for i in range(n):
        for k in range(3):
            mean[k] += points[i, k] / n
    covariance = np.zeros((3, 3))
    for i in range(n):
        for a in range(3):
            for b in range(a, 3):
                covariance[a, b] += (points[i, a] - mean[a]) * (points[i, b] - mean[b]) / n
    for a in range(3):
        for b in range(a):
            covariance[a, b] = covariance[b, a]
    variances, columns = np.linalg.eigh(covariance)
    return np.maximum(variances, 0.0), columns.T.copy()


@kernel
def sphere_fit(points: NDArray[np.float64]) -> tuple[float, float]:
    """Radius of the best sphere round points (N, 3), N > 3, and their rms distance from it, m.

    Algebraic least squares (Coope 1993); inf where there is none, as for a plane.
    """
    n = len(points)
    middle = np.zeros(3)
    for i in range(n):
        for k in range(3):
            middle[k] += points[i, k] / n
    A, b, row = np.zeros((4, 4)), np.zeros(4), np.ones(4)
    for i in range(n):
        square = 0.0
        for k in range(3):
            row[k] = points[i, k] - middle[k]
            square += row[k] * row[k]
        for p in range(4):
            b[p] += row[p] * square
            for q in range(4):
                A[p, q] += row[p] * row[q]
    for k in range(3):
        A[k, k] += 1e-9 * n
    x = np.linalg.solve(A, b)
    center = x[:3] / 2
    radius = math.sqrt(max(x[3] + center @ center, 0.0))
    total = 0.0
    for i in range(n):
        away = 0.0
        for k in range(3):
            away += (points[i, k] - middle[k] - center[k]) ** 2
        total += (math.sqrt(away) - radius) ** 2
    return radius, math.sqrt(total / n)


@kernel
def circle_fit(
    xy: NDArray[np.float64], low: float, high: float, along: NDArray[np.float64]
) -> tuple[float, float, float, float]:
    """Best circle round those points (N, 2) whose `along` (N,) lies between low and high.

    Returns radius, rms distance, and the greatest and least extent of the points across, all m;
    a radius of inf where there is none. Algebraic least squares (Kåsa 1976).
    """
    mx = my = 0.0
    n = 0
    for i in range(len(xy)):
        if low <= along[i] <= high:
            mx, my, n = mx + xy[i, 0], my + xy[i, 1], n + 1
    if n < 8:
        return math.inf, math.inf, 0.0, 0.0
    mx, my = mx / n, my / n
    A, b, row = np.zeros((3, 3)), np.zeros(3), np.ones(3)
    for i in range(len(xy)):
        if low <= along[i] <= high:
            row[0], row[1] = xy[i, 0] - mx, xy[i, 1] - my
            square = row[0] * row[0] + row[1] * row[1]
            for p in range(3):
                b[p] += row[p] * square
                for q in range(3):
                    A[p, q] += row[p] * row[q]
    A[0, 0] += 1e-9 * n
    A[1, 1] += 1e-9 * n
    x = np.linalg.solve(A, b)
    cx, cy = x[0] / 2, x[1] / 2
    radius = math.sqrt(max(x[2] + cx * cx + cy * cy, 0.0))
    total, across, narrow = 0.0, 0.0, math.inf
    for k in range(8):
        turn = k * math.pi / 8
        c, s = math.cos(turn), math.sin(turn)
        least, most = math.inf, -math.inf
        for i in range(len(xy)):
            if low <= along[i] <= high:
                at = c * xy[i, 0] + s * xy[i, 1]
                least, most = min(least, at), max(most, at)
        across, narrow = max(across, most - least), min(narrow, most - least)
    for i in range(len(xy)):
        if low <= along[i] <= high:
            away = math.hypot(xy[i, 0] - mx - cx, xy[i, 1] - my - cy)
            total += (away - radius) ** 2
    return radius, math.sqrt(total / n), across, narrow


@kernel
def slice_widths(along: NDArray[np.float64], across: NDArray[np.float64]) -> NDArray[np.float64]:
    """Width (SLICES,) of a body along its longest axis, m; 0 where too little of it is seen.

    Of an even spread: sqrt(12) standard deviations, which a few strays don't move.
    """
    low, high = along.min(), along.max()
    step = max(high - low, 1e-9) / SLICES
    sums = np.zeros((SLICES, 3))
    for i in range(len(along)):
        k = min(int((along[i] - low) / step), SLICES - 1)
        sums[k, 0] += 1.0
        sums[k, 1] += across[i]
        sums[k, 2] += across[i] * across[i]
    widths = np.zeros(SLICES)
    for k in range(SLICES):
        n = sums[k, 0]
        if n >= LEAST_IN_SLICE:
            mean = sums[k, 1] / n
            widths[k] = math.sqrt(12.0 * max(sums[k, 2] / n - mean * mean, 0.0))
    return widths


@kernel
def top_from_above(
    points: NDArray[np.float64], cell_m: float, within_m: float
) -> tuple[float, float, float]:
    """Of the squares that points (N, 3) fill from above: share that lies in one level top.

    Also the slope of that top, as rise over run, and its height: the one that most squares have.
    """
    n = len(points)
    low_x, low_y = points[:, 0].min(), points[:, 1].min()
    columns = int((points[:, 0].max() - low_x) / cell_m) + 1
    rows = int((points[:, 1].max() - low_y) / cell_m) + 1
    highest = np.full((columns, rows), -np.inf)
    for i in range(n):
        a, b = int((points[i, 0] - low_x) / cell_m), int((points[i, 1] - low_y) / cell_m)
        highest[a, b] = max(highest[a, b], points[i, 2])
    heights = highest.ravel()
    heights = heights[np.isfinite(heights)]
    level, best = heights[0], 0
    for h in heights:
        count = int((np.abs(heights - h) <= within_m).sum())
        if count > best:
            level, best = h, count
    A, b_, row = np.zeros((3, 3)), np.zeros(3), np.ones(3)
    for a in range(columns):
        for b in range(rows):
            if abs(highest[a, b] - level) <= within_m:
                row[0], row[1] = a * cell_m, b * cell_m
                for p in range(3):
                    b_[p] += row[p] * highest[a, b]
                    for q in range(3):
                        A[p, q] += row[p] * row[q]
    for k in range(3):
        A[k, k] += 1e-9
    x = np.linalg.solve(A, b_)
    return best / len(heights), math.hypot(x[0], x[1]), level


@kernel
def foot_share(points: NDArray[np.float64], foot_m: float) -> float:
    """Greatest extent, along x or y, of the points up to a height over that of all of them."""
    ends = np.empty((2, 2, 2))
    ends[:, 0], ends[:, 1] = math.inf, -math.inf
    for i in range(len(points)):
        for which in range(2):
            if which == 1 and points[i, 2] > foot_m:
                continue
            for k in range(2):
                ends[which, 0, k] = min(ends[which, 0, k], points[i, k])
                ends[which, 1, k] = max(ends[which, 1, k], points[i, k])
    whole = max(ends[0, 1, 0] - ends[0, 0, 0], ends[0, 1, 1] - ends[0, 0, 1], 1e-3)
    return float(max(ends[1, 1, 0] - ends[1, 0, 0], ends[1, 1, 1] - ends[1, 0, 1], 0.0) / whole)


@kernel
def missing_within(pixels: NDArray[np.int32], depth_m: NDArray[np.float32]) -> float:
    """Share of the pixels between a body's first and last one of each row that returned nothing."""
    width = depth_m.shape[1]
    first = np.full(depth_m.shape[0], width, np.int32)
    last = np.full(depth_m.shape[0], -1, np.int32)
    for p in pixels:
        v, u = p // width, p % width
        first[v], last[v] = min(first[v], u), max(last[v], u)
    missing = total = 0
    for v in range(depth_m.shape[0]):
        for u in range(first[v], last[v] + 1):
            total += 1
            missing += depth_m[v, u] <= 0
    return missing / max(total, 1)
