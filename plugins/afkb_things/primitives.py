"""The simple shape that fits a body best: box, cylinder, sphere, cone, or a superquadric."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OrientedBox, Primitive
from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel
from afkb_things.distances import (
    BOX,
    CONE,
    CYLINDER,
    LYING,
    N_PARAMETERS,
    SPHERE,
    SUPERQUADRIC,
    residuals,
)
from afkb_things.fitting import fit

BoxNumbers = tuple[float, float, float, float, float, float, float]
"""Centre, size and yaw of a box."""
SAMPLES = 48
ROUNDS = 5
DEEP_M = 0.010
"""What lies deeper inside a shape, the noise added, isn't of its surface but of a hollow."""
PER_PARAMETER = 0.03
"""A parameter more must better the fit by this share."""
GOOD_M = 0.001
"""Where the best upright box or cylinder is off by more than this and the noise, other shapes are
tried; where the best of these is, a superquadric."""
SQUARE, ROUND = 0.1, 1.0
MOST_GROWTH, LEAST_GROWTH = 2.2, 0.7
"""By how much a shape may be larger, or smaller, than what is seen of the body: half of a cylinder
that stands upright hides behind its front."""


def primitive_of(body: Body, box: OrientedBox) -> Primitive | None:
    """The shape whose surface the visible points lie on best; None where none is near.

    `box` is the upright one around what is seen of it, which the shapes start from.
    """
    points = np.ascontiguousarray(body.points[:: max(1, len(body.points) // SAMPLES)])
    kind, p, residual = _best_shape(points, (*box.center_xyz, *box.size_xyz, box.yaw), body.sigma_m)
    return None if kind < 0 else _primitive(kind, p, box.bottom, residual)


@kernel
def _best_shape(
    points: NDArray[np.float64], box: BoxNumbers, sigma_m: float
) -> tuple[int, NDArray[np.float64], float]:
    """Kind of the best shape, -1 for none, its parameters, and its residual, m."""
    base_m, deep = box[2] - box[5] / 2, DEEP_M + 3.0 * sigma_m
    best_kind, best, best_score, best_residual = -1, np.empty(0), math.inf, math.inf
    for kind in (BOX, CYLINDER, LYING, SPHERE, CONE, SUPERQUADRIC):
        if best_residual < GOOD_M + sigma_m and kind in (LYING, SUPERQUADRIC):
            break
        found = fit(kind, points, base_m, _start(kind, box), 0.5 * deep, ROUNDS)
        if not (np.isfinite(found).all() and _plausible(kind, found, box)):
            continue
        cut, residual = residuals(kind, points, base_m, found, deep)
        score = cut * (1.0 + PER_PARAMETER * N_PARAMETERS[kind])
        if score < best_score:
            best_kind, best, best_score, best_residual = kind, found, score, residual
    return (best_kind if best_score <= deep else -1), best, best_residual


@kernel
def _start(kind: int, box: BoxNumbers) -> NDArray[np.float64]:
    x, y, z = box[0], box[1], box[2]
    length, width, height = max(box[3], 0.01), max(box[4], 0.01), max(box[5], 0.01)
    top, yaw, radius = z + box[5] / 2, box[6], 0.25 * (length + width)
    if kind == CYLINDER:
        return np.array([x, y, radius, top])
    if kind == LYING:
        return np.array([x, y, height / 2, length / 2, yaw])
    if kind == SPHERE:
        return np.array([x, y, z, radius])
    if kind == CONE:
        return np.array([x, y, 0.9 * radius, radius, top])
    if kind == BOX:
        return np.array([x, y, length / 2, width / 2, yaw, top])
    return np.array([x, y, length / 2, width / 2, yaw, top, 0.5, 0.5])


@kernel
def _plausible(kind: int, p: NDArray[np.float64], box: BoxNumbers) -> bool:
    """Whether a shape is about as large as what is seen of it, and where that is."""
    base_m, box_top = box[2] - box[5] / 2, box[2] + box[5] / 2
    if kind in (BOX, SUPERQUADRIC):
        one, other, top = 2 * p[2], 2 * p[3], p[5]
    elif kind == LYING:
        one, other, top = 2 * p[2], 2 * p[3], base_m + 2 * p[2]
    elif kind == SPHERE:
        one, other, top = 2 * p[3], 2 * p[3], p[2] + p[3]
    else:
        radius = p[2] if kind == CYLINDER else max(p[2], p[3])
        one, other, top = 2 * radius, 2 * radius, p[4 if kind == CONE else 3]
    narrow, wide = min(box[3], box[4]), max(box[3], box[4])
    grown = _grown(narrow, min(one, other)) and _grown(wide, max(one, other))
    higher = abs(top - box_top) < 0.2 * box[5] + DEEP_M
    return grown and higher and math.hypot(p[0] - box[0], p[1] - box[1]) < 0.75 * wide


@kernel
def _grown(seen_m: float, has_m: float) -> bool:
    return LEAST_GROWTH * seen_m - DEEP_M < has_m < MOST_GROWTH * seen_m + DEEP_M


def _primitive(kind: int, p: NDArray[np.float64], base_m: float, residual_m: float) -> Primitive:
    T = np.eye(4)
    if kind == SPHERE:
        T[:3, 3] = p[:3]
        return Primitive("sphere", T, (2 * p[3],) * 3, (ROUND, ROUND), residual_m)
    if kind == LYING:
        cos, sin = math.cos(p[4]), math.sin(p[4])
        T[:3, :3] = np.array([[0, sin, cos], [0, -cos, sin], [1, 0, 0]])
        T[:3, 3] = p[0], p[1], base_m + p[2]
        size = (2 * p[2], 2 * p[2], 2 * p[3])
        return Primitive("cylinder", T, size, (SQUARE, ROUND), residual_m)
    top = float(p[{CYLINDER: 3, CONE: 4}.get(kind, 5)])
    T[:3, 3] = p[0], p[1], (top + base_m) / 2
    if kind in (CYLINDER, CONE):
        if kind == CONE and p[3] > p[2]:  # its narrow end is below
            T[1, 1] = T[2, 2] = -1.0
        radius = max(p[2], p[3]) if kind == CONE else p[2]
        name = "cone" if kind == CONE else "cylinder"
        size = (2 * radius, 2 * radius, top - base_m)
        return Primitive(name, T, size, (SQUARE, ROUND), residual_m)
    cos, sin = math.cos(p[4]), math.sin(p[4])
    T[:2, :2] = [[cos, -sin], [sin, cos]]
    exponents = (SQUARE, SQUARE) if kind == BOX else (float(p[6]), float(p[7]))
    size = (2 * p[2], 2 * p[3], top - base_m)
    return Primitive("box" if kind == BOX else "superquadric", T, size, exponents, residual_m)


def box_of(shape: Primitive) -> OrientedBox:
    """The upright box around a shape, its long side along x."""
    T, size = shape.T_map_body, np.array(shape.size_xyz)
    x, y, z = (float(c) for c in T[:3, 3])
    if abs(T[2, 2]) > 0.5:
        along, yaw = size, math.atan2(T[1, 0], T[0, 0])
    else:
        along, yaw = size[[2, 1, 0]], math.atan2(T[1, 2], T[0, 2])
    length, width, height = (float(s) for s in along)
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    yaw = (yaw + math.pi / 2) % math.pi - math.pi / 2
    return OrientedBox((x, y, z), (length, width, height), yaw)
