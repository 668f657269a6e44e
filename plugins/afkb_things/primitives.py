"""The simple shape that fits a body best: box, cylinder, sphere, cone, or a superquadric."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OrientedBox, Primitive
from afkb_mapping.bodies import Body
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
    points = body.points[:: max(1, len(body.points) // SAMPLES)].astype(np.float64)
    sigma = body.sigma_m
    deep = DEEP_M + 3.0 * sigma
    best: tuple[float, float, int, NDArray[np.float64]] | None = None
    for kind in (BOX, CYLINDER, LYING, SPHERE, CONE, SUPERQUADRIC):
        if best is not None and best[1] < GOOD_M + sigma and kind in (LYING, SUPERQUADRIC):
            break
        start = _start(kind, box)
        found = fit(kind, points, box.bottom, start, 0.5 * deep, ROUNDS)
        if not (np.isfinite(found).all() and _plausible(kind, found, box)):
            continue
        cut, residual = residuals(kind, points, box.bottom, found, deep)
        score = cut * (1.0 + PER_PARAMETER * N_PARAMETERS[kind])
        if best is None or score < best[0]:
            best = (score, residual, kind, found)
    if best is None or best[0] > deep:
        return None
    return _primitive(best[2], best[3], box.bottom, best[1])


def _start(kind: int, box: OrientedBox) -> NDArray[np.float64]:
    x, y, z = box.center_xyz
    length, width, height = (max(s, 0.01) for s in box.size_xyz)
    radius = 0.25 * (length + width)
    starts = {
        BOX: (x, y, length / 2, width / 2, box.yaw, box.top),
        CYLINDER: (x, y, radius, box.top),
        LYING: (x, y, height / 2, length / 2, box.yaw),
        SPHERE: (x, y, z, radius),
        CONE: (x, y, 0.9 * radius, radius, box.top),
        SUPERQUADRIC: (x, y, length / 2, width / 2, box.yaw, box.top, 0.5, 0.5),
    }
    return np.array(starts[kind])


def _plausible(kind: int, p: NDArray[np.float64], box: OrientedBox) -> bool:
    """Whether a shape is about as large as what is seen of it, and where that is."""
    if kind in (BOX, SUPERQUADRIC):
        sides, top = (2 * p[2], 2 * p[3]), p[5]
    elif kind == LYING:
        sides, top = (2 * p[2], 2 * p[3]), box.bottom + 2 * p[2]
    elif kind == SPHERE:
        sides, top = (2 * p[3], 2 * p[3]), p[2] + p[3]
    else:
        radius = p[2] if kind == CYLINDER else max(p[2], p[3])
        sides, top = (2 * radius, 2 * radius), p[4 if kind == CONE else 3]
    seen, has = sorted(box.size_xyz[:2]), sorted(sides)
    grown = all(
        LEAST_GROWTH * s - DEEP_M < h < MOST_GROWTH * s + DEEP_M
        for s, h in zip(seen, has, strict=True)
    )
    higher = abs(top - box.top) < 0.2 * box.size_xyz[2] + DEEP_M
    off = math.hypot(p[0] - box.center_xyz[0], p[1] - box.center_xyz[1])
    return bool(grown and higher and off < 0.75 * seen[1])


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
