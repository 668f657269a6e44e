"""Compiled loops over the points of a thing that is looked into from above."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile

SECTORS = 16
RIM_BAND_M = 0.006
BELOW_BAND_M = 0.003
MIN_PENETRATION_M = 0.02
FALLING_M = -0.02
CROSSING_MARGIN_M, POINT_MARGIN_M = 0.002, -0.01
"""How far inside the rim a sight line crosses its plane, and how far what it ends at may lie."""
WALL_M = 0.01
"""As wide as the walls of mugs and bowls are, with a depth step beside: further in, there is a lid
or a hollow."""


@kernel
def rim_of(
    points: NDArray[np.float64],
    depth_m: NDArray[np.float32],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
    sigma_m: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far each point (N, 3) may lie below the rim by noise alone, m; (M, 2) of those on it."""
    n = len(points)
    bands, rim_xy, count = np.empty(n), np.empty((n, 2)), 0
    for k in range(n):
        slope = (points[k, 2] - camera_xyz[2]) / depth_m[k]
        bands[k] = max(RIM_BAND_M, 2.5 * math.sqrt((sigma_m * slope) ** 2 + 0.001**2))
        if points[k, 2] > rim_m - bands[k]:
            rim_xy[count, 0], rim_xy[count, 1] = points[k, 0], points[k, 1]
            count += 1
    return bands, rim_xy[:count]


@kernel
def border_lines(
    corners: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Inward normals (K, 2) and offsets (K,) of a convex polygon: inside, normal . p >= offset."""
    n = len(corners)
    normals, offsets, area = np.empty((n, 2)), np.empty(n), 0.0
    for k in range(n):
        a, b = corners[k], corners[(k + 1) % n]
        area += a[0] * b[1] - b[0] * a[1]
        length = max(math.hypot(b[0] - a[0], b[1] - a[1]), 1e-9)
        normals[k, 0], normals[k, 1] = (a[1] - b[1]) / length, (b[0] - a[0]) / length
    normals *= np.sign(area)
    for k in range(n):
        offsets[k] = corners[k, 0] * normals[k, 0] + corners[k, 1] * normals[k, 1]
    return normals, offsets


@kernel
def within(
    x: float, y: float, normals: NDArray[np.float64], offsets: NDArray[np.float64], margin: float
) -> bool:
    """Whether a point lies inside a convex polygon, at least a margin (m) from its border."""
    for k in range(len(offsets)):
        if x * normals[k, 0] + y * normals[k, 1] < offsets[k] + margin:
            return False
    return True


@kernel
def seen_inside(
    points: NDArray[np.float64],
    bands: NDArray[np.float64],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
    sigma_m: float,
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.float64], int]:
    """Points clearly below the rim and seen through it: indexes, and where (N, 2) they cross it.

    And the number of sight lines that cross the rim's plane within the rim.
    """
    inside, crossing = np.empty(len(points), np.int64), np.empty((len(points), 2))
    count = through = 0
    drop, least = camera_xyz[2] - rim_m, max(MIN_PENETRATION_M, 4 * sigma_m)
    for k in range(len(points)):
        dx, dy = points[k, 0] - camera_xyz[0], points[k, 1] - camera_xyz[1]
        dz = points[k, 2] - camera_xyz[2]
        falling = dz < FALLING_M
        t = drop / -dz if falling else 2.0
        x, y = camera_xyz[0] + dx * t, camera_xyz[1] + dy * t
        if not within(x, y, normals, offsets, 0.0):
            continue
        through += 1
        if not falling or rim_m - points[k, 2] <= bands[k] + BELOW_BAND_M:
            continue
        if math.sqrt(dx * dx + dy * dy + dz * dz) * (1 - t) <= least:
            continue
        if within(x, y, normals, offsets, CROSSING_MARGIN_M) and within(
            points[k, 0], points[k, 1], normals, offsets, POINT_MARGIN_M
        ):
            inside[count], crossing[count, 0], crossing[count, 1] = k, x, y
            count += 1
    return inside[:count], crossing[:count], through


@kernel
def ends_on_top(
    points: NDArray[np.float64],
    bands: NDArray[np.float64],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> tuple[int, float]:
    """Sight lines that cross the rim WALL_M or more inside; the share that end at its height."""
    through = on_top = 0
    drop = camera_xyz[2] - rim_m
    for k in range(len(points)):
        dz = points[k, 2] - camera_xyz[2]
        if dz >= FALLING_M:
            continue
        t = drop / -dz
        x = camera_xyz[0] + (points[k, 0] - camera_xyz[0]) * t
        y = camera_xyz[1] + (points[k, 1] - camera_xyz[1]) * t
        if within(x, y, normals, offsets, WALL_M):
            through += 1
            on_top += rim_m - points[k, 2] <= bands[k] + BELOW_BAND_M
    return through, on_top / max(through, 1)


@kernel
def depth_and_steepness(
    points: NDArray[np.float64],
    inside: NDArray[np.int64],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
) -> tuple[float, float]:
    """Depth seen below the rim, m, and the fall of its sight lines per metre of ground covered."""
    n = len(inside)
    below, fall = np.empty(n), np.empty(n)
    for k in range(n):
        p = points[inside[k]]
        below[k] = rim_m - p[2]
        fall[k] = (camera_xyz[2] - p[2]) / math.hypot(p[0] - camera_xyz[0], p[1] - camera_xyz[1])
    return percentile(below, 90.0), percentile(fall, 50.0)


@kernel
def share_around(rim_xy: NDArray[np.float64], inside_xy: NDArray[np.float64]) -> float:
    """Share of directions, from the middle of what is seen inside, in which there is rim."""
    x = y = 0.0
    for k in range(len(inside_xy)):
        x, y = x + inside_xy[k, 0], y + inside_xy[k, 1]
    x, y = x / len(inside_xy), y / len(inside_xy)
    seen = np.zeros(SECTORS, np.bool_)
    for k in range(len(rim_xy)):
        turn = math.atan2(rim_xy[k, 1] - y, rim_xy[k, 0] - x) / (2 * math.pi) + 0.5
        seen[int(turn * SECTORS) % SECTORS] = True
    return float(seen.sum()) / SECTORS
