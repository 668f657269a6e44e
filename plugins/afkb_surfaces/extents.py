"""How high, how level and how far a labelled surface is, worked out from its pixels."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.from_above import squares_of
from afkb_mapping.kernels import kernel

HEIGHT_BIN_M = 0.004
SLOPE_SAMPLES = 4000
MAX_SQUARES = 250_000
MIN_AROUND = 3
"""A square with fewer neighbours than this is a stray."""


@kernel
def mode_height(points: NDArray[np.float64]) -> float:
    """Height at which most of a surface (N, 3) lies: mean of what is around the fullest bin, m."""
    low = high = points[0, 2]
    for n in range(1, len(points)):
        low, high = min(low, points[n, 2]), max(high, points[n, 2])
    counts = np.zeros(int((high - low) / HEIGHT_BIN_M) + 3, np.int64)
    for n in range(len(points)):
        counts[int((points[n, 2] - low) / HEIGHT_BIN_M) + 1] += 1
    best, fullest = 0, -1
    for k in range(1, len(counts) - 1):
        around = counts[k - 1] + counts[k] + counts[k + 1]
        if around > fullest:
            best, fullest = k - 1, around
    centre = low + (best + 0.5) * HEIGHT_BIN_M
    total, count = 0.0, 0
    for n in range(len(points)):
        if abs(points[n, 2] - centre) <= 2.5 * HEIGHT_BIN_M:
            total += points[n, 2]
            count += 1
    return total / count


@kernel
def tilt_and_rms(points: NDArray[np.float64]) -> tuple[float, float]:
    """Tilt of the plane through points (N, 3) from level, degrees, and their rms about it, m."""
    thin = max(1, len(points) // SLOPE_SAMPLES)
    p = points[::thin]
    n = len(p)
    mx = my = mz = 0.0
    for k in range(n):
        mx, my, mz = mx + p[k, 0], my + p[k, 1], mz + p[k, 2]
    mx, my, mz = mx / n, my / n, mz / n
    # the ridge keeps a row of points, which says nothing across itself, level that way
    xx = yy = 1e-6 * n
    xy = xz = yz = 0.0
    for k in range(n):
        x, y, z = p[k, 0] - mx, p[k, 1] - my, p[k, 2] - mz
        xx, xy, yy, xz, yz = xx + x * x, xy + x * y, yy + y * y, xz + x * z, yz + y * z
    det = xx * yy - xy * xy
    a, b = (xz * yy - yz * xy) / det, (yz * xx - xz * xy) / det
    total = 0.0
    for k in range(n):
        off = p[k, 2] - mz - a * (p[k, 0] - mx) - b * (p[k, 1] - my)
        total += off * off
    return math.degrees(math.atan(math.hypot(a, b))), math.sqrt(total / n)


@kernel
def filled_footprint(
    points: NDArray[np.float64],
    labels: NDArray[np.int32],
    label: int,
    height_m: float,
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
) -> NDArray[np.float64]:
    """Grid squares of a surface: those its points fall in, and those that project onto it.

    Rows of a distant, grazing surface fall several squares apart; projecting the squares into
    the image fills what lies between them. Returns their centres (M, 2), sorted, m.
    """
    low, span, ij = squares_of(points, step_m)
    x0, y0 = (low[0] + 0.5) * step_m, (low[1] + 0.5) * step_m
    hit = np.zeros((span[0] + 2, span[1] + 2), np.bool_)
    small = span[0] * span[1] <= MAX_SQUARES
    if small:
        _project(hit, x0, y0, labels, label, height_m, intrinsics, T_map_camera, step_m)
    for n in range(len(ij)):
        hit[ij[n, 0] - low[0] + 1, ij[n, 1] - low[1] + 1] = True
    around = MIN_AROUND if small else 0
    if _count(hit, around) == 0:
        around = 0
    out = np.empty((_count(hit, around), 2))
    n = 0
    for i in range(span[0]):
        for j in range(span[1]):
            if hit[i + 1, j + 1] and _neighbours(hit, i + 1, j + 1) >= around:
                out[n, 0], out[n, 1] = x0 + step_m * i, y0 + step_m * j
                n += 1
    return out


@kernel
def _project(
    hit: NDArray[np.bool_],
    x0: float,
    y0: float,
    labels: NDArray[np.int32],
    label: int,
    height_m: float,
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
    step_m: float,
) -> None:
    """Mark the squares at height_m whose centre is seen in a pixel of the label."""
    fx, fy, cx, cy = intrinsics
    rows, cols = labels.shape
    dz = height_m - T[2, 3]
    for i in range(hit.shape[0] - 2):
        dx = x0 + step_m * i - T[0, 3]
        for j in range(hit.shape[1] - 2):
            dy = y0 + step_m * j - T[1, 3]
            depth = T[0, 2] * dx + T[1, 2] * dy + T[2, 2] * dz
            if depth <= 0.1:
                continue
            u = np.rint((T[0, 0] * dx + T[1, 0] * dy + T[2, 0] * dz) / depth * fx + cx)
            v = np.rint((T[0, 1] * dx + T[1, 1] * dy + T[2, 1] * dz) / depth * fy + cy)
            if 0 <= u < cols and 0 <= v < rows:
                hit[i + 1, j + 1] = labels[int(v), int(u)] == label


@kernel
def _neighbours(hit: NDArray[np.bool_], i: int, j: int) -> int:
    count = -1
    for di in range(-1, 2):
        for dj in range(-1, 2):
            count += hit[i + di, j + dj]
    return count


@kernel
def _count(hit: NDArray[np.bool_], around: int) -> int:
    """Squares that are hit and have at least this many neighbours; the margin isn't looked at."""
    count = 0
    for i in range(1, hit.shape[0] - 1):
        for j in range(1, hit.shape[1] - 1):
            if hit[i, j] and (around == 0 or _neighbours(hit, i, j) >= around):
                count += 1
    return count
