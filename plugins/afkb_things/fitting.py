"""Parameters of simple shapes by least squares of the distances of points from their surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_things.distances import (
    BOX,
    CYLINDER,
    LEAST_SIDE_M,
    LYING,
    SPHERE,
    SUPERQUADRIC,
    distance,
    slopes,
)

PULL = 1e-3
"""Weight of a parameter's way from its start, against that of a point's distance."""
ENOUGH = 1e-3
"""A step that betters the fit by a smaller share is the last."""


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
    p, n, damping = start.copy(), len(start), 1e-3
    left, right = np.empty((n, n)), np.empty(n)
    new_left, new_right = np.empty((n, n)), np.empty(n)
    best = _normal_equations(kind, points, base_m, p, start, scale_m, left, right)
    for _ in range(rounds):
        damped = left.copy()
        for i in range(n):
            damped[i, i] *= 1.0 + damping
        tried = bounded(kind, p + np.linalg.solve(damped, right), base_m)
        cost = _normal_equations(kind, points, base_m, tried, start, scale_m, new_left, new_right)
        if cost < best:
            done = best - cost < ENOUGH * best
            p, best, damping = tried, cost, damping * 0.3
            left, new_left, right, new_right = new_left, left, new_right, right
            if done:
                break
        else:
            damping *= 10.0
    return p


@kernel
def _normal_equations(
    kind: int,
    points: NDArray[np.float64],
    base_m: float,
    p: NDArray[np.float64],
    start: NDArray[np.float64],
    scale_m: float,
    left: NDArray[np.float64],
    right: NDArray[np.float64],
) -> float:
    """What `fit` makes small: Geman and McClure's loss of the distances, and the pull.

    Into `left` (n, n) and `right` (n,) the equations of the step that does so.
    """
    n, loss = len(p), 0.0
    row = np.zeros(n)
    left[:], right[:] = 0.0, 0.0
    for k in range(len(points)):
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        d = distance(kind, x, y, z, p, base_m)
        slopes(kind, x, y, z, p, base_m, row)
        share = (d / scale_m) ** 2
        loss += share / (1.0 + share)
        w = 1.0 / (1.0 + share) ** 2
        for i in range(n):
            right[i] -= w * row[i] * d
            for j in range(i + 1):
                left[i, j] += w * row[i] * row[j]
    pull, total = PULL * len(points), loss * scale_m * scale_m
    for i in range(n):
        for j in range(i):
            left[j, i] = left[i, j]
        left[i, i] += pull
        right[i] -= pull * (p[i] - start[i])
        total += pull * (p[i] - start[i]) ** 2
    return total


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
