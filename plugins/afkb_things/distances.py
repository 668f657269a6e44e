"""How far points lie from the surface of simple shapes that stand on a support."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

BOX, CYLINDER, LYING, SPHERE, CONE, SUPERQUADRIC = range(6)
"""Kinds by number; a lying cylinder is one whose axis is level."""
N_PARAMETERS = (6, 4, 5, 4, 5, 8)
STEP = 1e-5
"""Metres, or radians, by which slopes are taken."""
PULL = 1e-3
"""Weight of a parameter's way from its start, against that of a point's distance."""
LEAST_SIDE_M = 0.004


@kernel
def distance(
    kind: int, x: float, y: float, z: float, p: NDArray[np.float64], base_m: float
) -> float:
    """Signed distance of a point from a shape's surface, m, below 0 inside; exact but for the last.

    Parameters, all but the sphere standing on `base_m`: box (x, y, half sides, yaw, top), cylinder
    (x, y, radius, top), lying cylinder (x, y, radius, half length, yaw), sphere (x, y, z, radius),
    cone (x, y, radius at its bottom, at its top, top), superquadric (as box, and e1, e2).
    """
    x, y = x - p[0], y - p[1]
    if kind == SPHERE:
        return math.sqrt(x * x + y * y + (z - p[2]) ** 2) - p[3]
    if kind == LYING:
        cos, sin = math.cos(p[4]), math.sin(p[4])
        along, across = x * cos + y * sin, y * cos - x * sin
        return _capped(
            math.sqrt(across * across + (z - base_m - p[2]) ** 2) - p[2], abs(along) - p[3]
        )
    if kind == CYLINDER:
        half = 0.5 * (p[3] - base_m)
        return _capped(math.sqrt(x * x + y * y) - p[2], abs(z - base_m - half) - half)
    if kind == CONE:
        half = 0.5 * (p[4] - base_m)
        slope = (p[3] - p[2]) / max(2.0 * half, 1e-3)
        radius = p[2] + slope * (z - base_m)
        side = (math.sqrt(x * x + y * y) - radius) / math.sqrt(1.0 + slope * slope)
        return _capped(side, abs(z - base_m - half) - half)
    cos, sin = math.cos(p[4]), math.sin(p[4])
    half = 0.5 * (p[5] - base_m)
    a, b, c = abs(x * cos + y * sin), abs(y * cos - x * sin), abs(z - base_m - half)
    if kind == BOX:
        a, b, c = a - p[2], b - p[3], c - half
        outside = math.sqrt(max(a, 0.0) ** 2 + max(b, 0.0) ** 2 + max(c, 0.0) ** 2)
        return outside + min(max(a, b, c), 0.0)
    # radial distance of Whaite and Ferrie (1991)
    e1, e2 = p[6], p[7]
    flat = ((a / p[2]) ** (2.0 / e2) + (b / p[3]) ** (2.0 / e2)) ** (e2 / e1)
    f = flat + (c / max(half, 1e-3)) ** (2.0 / e1)
    return math.sqrt(a * a + b * b + c * c) * (1.0 - max(f, 1e-9) ** (-0.5 * e1))


@kernel
def _capped(side: float, cap: float) -> float:
    """Distance from a shape that ends at caps at right angles to its side."""
    if side > 0.0 and cap > 0.0:
        return math.sqrt(side * side + cap * cap)
    return max(side, cap)


@kernel
def fit(
    kind: int,
    points: NDArray[np.float64],
    base_m: float,
    start: NDArray[np.float64],
    scale_m: float,
    rounds: int,
) -> NDArray[np.float64]:
    """Parameters by damped, reweighted least squares of the distances of points (N, 3).

    What lies further off than `scale_m` counts little: the inside of a hollow, a handle. A slight
    pull to the start holds what nothing is seen of.
    """
    p, n = start.copy(), len(start)
    damping, best = 1e-3, _cost(kind, points, base_m, p, start, scale_m)
    row = np.empty(n)
    for _ in range(rounds):
        left, right = np.zeros((n, n)), np.zeros(n)
        for k in range(len(points)):
            x, y, z = points[k, 0], points[k, 1], points[k, 2]
            d = distance(kind, x, y, z, p, base_m)
            w = 1.0 / (1.0 + (d / scale_m) ** 2) ** 2
            for i in range(n):
                was = p[i]
                p[i] = was + STEP
                row[i] = (distance(kind, x, y, z, p, base_m) - d) / STEP
                p[i] = was
            for i in range(n):
                right[i] -= w * row[i] * d
                for j in range(n):
                    left[i, j] += w * row[i] * row[j]
        pull = PULL * len(points)
        for i in range(n):
            left[i, i] += pull
            right[i] -= pull * (p[i] - start[i])
        for i in range(n):
            left[i, i] *= 1.0 + damping
        tried = bounded(kind, p + np.linalg.solve(left, right), base_m)
        cost = _cost(kind, points, base_m, tried, start, scale_m)
        if cost < best:
            done = best - cost < 1e-3 * best
            p, best, damping = tried, cost, damping * 0.3
            if done:
                break
        else:
            damping *= 10.0
    return p


@kernel
def bounded(kind: int, p: NDArray[np.float64], base_m: float) -> NDArray[np.float64]:
    """The parameters, kept to what a shape can have."""
    if kind in (BOX, SUPERQUADRIC):
        p[2], p[3], p[5] = (
            max(p[2], LEAST_SIDE_M),
            max(p[3], LEAST_SIDE_M),
            max(p[5], base_m + LEAST_SIDE_M),
        )
        if kind == SUPERQUADRIC:
            p[6], p[7] = min(max(p[6], 0.1), 1.9), min(max(p[7], 0.1), 1.9)
    elif kind == CYLINDER:
        p[2], p[3] = max(p[2], LEAST_SIDE_M), max(p[3], base_m + LEAST_SIDE_M)
    elif kind == LYING:
        p[2], p[3] = max(p[2], LEAST_SIDE_M), max(p[3], LEAST_SIDE_M)
    elif kind == SPHERE:
        p[3] = max(p[3], LEAST_SIDE_M)
    else:
        p[2], p[3], p[4] = max(p[2], 0.0), max(p[3], 0.0), max(p[4], base_m + LEAST_SIDE_M)
    return p


@kernel
def _cost(
    kind: int,
    points: NDArray[np.float64],
    base_m: float,
    p: NDArray[np.float64],
    start: NDArray[np.float64],
    scale_m: float,
) -> float:
    """What `fit` makes small: Geman and McClure's loss of the distances, and the pull."""
    total = 0.0
    for k in range(len(points)):
        d = distance(kind, points[k, 0], points[k, 1], points[k, 2], p, base_m) / scale_m
        total += d * d / (1.0 + d * d)
    total *= scale_m * scale_m
    for i in range(len(p)):
        total += PULL * len(points) * (p[i] - start[i]) ** 2
    return total


@kernel
def residuals(
    kind: int,
    points: NDArray[np.float64],
    base_m: float,
    p: NDArray[np.float64],
    deep_m: float,
) -> tuple[float, float]:
    """Rms distance of points (N, 3), m: of all, cut at deep_m, and of those not deeper inside."""
    cut = total = 0.0
    count = 0
    for k in range(len(points)):
        d = distance(kind, points[k, 0], points[k, 1], points[k, 2], p, base_m)
        cut += min(d * d, deep_m * deep_m)
        if d > -deep_m:
            total += d * d
            count += 1
    return math.sqrt(cut / len(points)), math.sqrt(total / max(count, 1))
