"""How far points lie from the surface of simple shapes that stand on a support, and its slopes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

BOX, CYLINDER, LYING, SPHERE, CONE, SUPERQUADRIC = range(6)
"""Kinds by number; a lying cylinder is one whose axis is level."""
N_PARAMETERS = (6, 4, 5, 4, 5, 8)
LEAST_SIDE_M = 0.004
TINY = 1e-9


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


@kernel
def slopes(
    kind: int,
    x: float,
    y: float,
    z: float,
    p: NDArray[np.float64],
    base_m: float,
    out: NDArray[np.float64],
) -> None:
    """How a point's `distance` changes with each parameter, into `out` (n,)."""
    x, y = x - p[0], y - p[1]
    if kind == SPHERE:
        off = max(math.sqrt(x * x + y * y + (z - p[2]) ** 2), TINY)
        out[0], out[1], out[2], out[3] = -x / off, -y / off, (p[2] - z) / off, -1.0
    elif kind == LYING:
        _lying_slopes(x, y, z - base_m, p, out)
    elif kind in (CYLINDER, CONE):
        _upright_slopes(kind, x, y, z - base_m, p, base_m, out)
    else:
        _cornered_slopes(kind, x, y, z, p, base_m, out)


@kernel
def _lying_slopes(
    x: float, y: float, z: float, p: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    cos, sin = math.cos(p[4]), math.sin(p[4])
    along, across = x * cos + y * sin, y * cos - x * sin
    off = max(math.sqrt(across * across + (z - p[2]) ** 2), TINY)
    side, cap = _shares(off - p[2], abs(along) - p[3])
    by_across, by_along = side * across / off, cap * (1.0 if along > 0 else -1.0)
    out[0] = by_across * sin - by_along * cos
    out[1] = -by_across * cos - by_along * sin
    out[2] = side * ((p[2] - z) / off - 1.0)
    out[3] = -cap
    out[4] = by_along * across - by_across * along


@kernel
def _upright_slopes(
    kind: int,
    x: float,
    y: float,
    z: float,
    p: NDArray[np.float64],
    base_m: float,
    out: NDArray[np.float64],
) -> None:
    top = 3 if kind == CYLINDER else 4
    tall = p[top] - base_m
    off = max(math.sqrt(x * x + y * y), TINY)
    cap_m = abs(z - 0.5 * tall) - 0.5 * tall
    by_top = -0.5 - (0.5 if z > 0.5 * tall else -0.5)
    if kind == CYLINDER:
        side, cap = _shares(off - p[2], cap_m)
        out[0], out[1], out[2], out[3] = -side * x / off, -side * y / off, -side, cap * by_top
        return
    tall = max(tall, 1e-3)
    slope = (p[3] - p[2]) / tall
    lean = math.sqrt(1.0 + slope * slope)
    gap = off - p[2] - slope * z
    side, cap = _shares(gap / lean, cap_m)
    # a steeper side is as much nearer as it leans, and lies elsewhere
    by_slope = side * (-z / lean - gap * slope / lean**3)
    out[0], out[1] = -side * x / (off * lean), -side * y / (off * lean)
    out[2] = -side / lean - by_slope / tall
    out[3] = by_slope / tall
    out[4] = cap * by_top - by_slope * slope / tall


@kernel
def _cornered_slopes(
    kind: int,
    x: float,
    y: float,
    z: float,
    p: NDArray[np.float64],
    base_m: float,
    out: NDArray[np.float64],
) -> None:
    """Of a box or a superquadric: through the slopes along its own axes."""
    cos, sin = math.cos(p[4]), math.sin(p[4])
    half = 0.5 * (p[5] - base_m)
    x, y, z = x * cos + y * sin, y * cos - x * sin, z - base_m - half
    if kind == BOX:
        a, b, c = abs(x) - p[2], abs(y) - p[3], abs(z) - half
        outside = math.sqrt(max(a, 0.0) ** 2 + max(b, 0.0) ** 2 + max(c, 0.0) ** 2)
        if outside > 0.0:
            by_a, by_b, by_c = max(a, 0.0) / outside, max(b, 0.0) / outside, max(c, 0.0) / outside
        else:
            most = max(a, b, c)
            by_a = 1.0 if a == most else 0.0
            by_b = 1.0 if b == most and a != most else 0.0
            by_c = 1.0 - by_a - by_b
        out[2], out[3], by_half = -by_a, -by_b, -by_c
    else:
        by_a, by_b, by_c, by_half = _superquadric_slopes(abs(x), abs(y), abs(z), p, half, out)
    by_x, by_y = by_a * (1.0 if x > 0 else -1.0), by_b * (1.0 if y > 0 else -1.0)
    out[0], out[1] = by_y * sin - by_x * cos, -by_x * sin - by_y * cos
    out[4] = by_x * y - by_y * x
    out[5] = 0.5 * (by_half - by_c * (1.0 if z > 0 else -1.0))


@kernel
def _superquadric_slopes(
    a: float, b: float, c: float, p: NDArray[np.float64], half: float, out: NDArray[np.float64]
) -> tuple[float, float, float, float]:
    """Slopes along its axes and with its half height; those with its sides and exponents: `out`."""
    e1, e2, half = p[6], p[7], max(half, 1e-3)
    a, b, c = max(a, TINY), max(b, TINY), max(c, TINY)
    log_a, log_b, log_c = math.log(a / p[2]), math.log(b / p[3]), math.log(c / half)
    of_a, of_b, of_c = (
        math.exp(2.0 / e2 * log_a),
        math.exp(2.0 / e2 * log_b),
        math.exp(2.0 / e1 * log_c),
    )
    flat = of_a + of_b
    level = flat ** (e2 / e1)
    f = max(level + of_c, 1e-9)
    off, g = math.sqrt(a * a + b * b + c * c), f ** (-0.5 * e1)
    by_f = 0.5 * e1 * off * g / f
    by_flat = by_f * 2.0 / e1 * level / flat
    by_up = by_f * 2.0 / e1 * of_c
    out[2], out[3] = -by_flat * of_a / p[2], -by_flat * of_b / p[3]
    log_flat = math.log(flat)
    turned = level * log_flat * -e2 / (e1 * e1) + of_c * log_c * -2.0 / (e1 * e1)
    out[6] = by_f * turned + 0.5 * off * g * math.log(f)
    bent = log_flat / e1 - 2.0 / (e1 * e2) * (of_a * log_a + of_b * log_b) / flat
    out[7] = by_f * level * bent
    out_a = a / off * (1.0 - g) + by_flat * of_a / a
    out_b = b / off * (1.0 - g) + by_flat * of_b / b
    return out_a, out_b, c / off * (1.0 - g) + by_up / c, -by_up / half


@kernel
def _shares(side: float, cap: float) -> tuple[float, float]:
    """How `_capped` changes with the distances from side and cap."""
    if side > 0.0 and cap > 0.0:
        off = math.sqrt(side * side + cap * cap)
        return side / off, cap / off
    return (1.0, 0.0) if side > cap else (0.0, 1.0)
