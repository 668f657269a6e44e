"""Points seen from above: the grid squares that they fill, and the smallest box around them."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import OrientedBox
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentiles

THICKNESS_M = 0.02
"""Depth given to the box of a surface whose underside isn't seen."""
SIDE_SAMPLES = 1500


@kernel
def on_grid(xy: NDArray[np.float64], step_m: float) -> NDArray[np.float64]:
    """Centres of the grid squares that hold points (N, 2+): (M, 2), sorted, step_m apart."""
    low, span, ij = squares_of(xy, step_m)
    hit = np.zeros((span[0], span[1]), np.bool_)
    count = 0
    for n in range(len(ij)):
        i, j = ij[n, 0] - low[0], ij[n, 1] - low[1]
        if not hit[i, j]:
            hit[i, j] = True
            count += 1
    out = np.empty((count, 2))
    n = 0
    for i in range(span[0]):
        for j in range(span[1]):
            if hit[i, j]:
                out[n, 0], out[n, 1] = (low[0] + i + 0.5) * step_m, (low[1] + j + 0.5) * step_m
                n += 1
    return out


@kernel
def squares_of(
    xy: NDArray[np.float64], step_m: float
) -> tuple[tuple[int, int], tuple[int, int], NDArray[np.int64]]:
    """Lowest grid square of points (N, 2+), N > 0; how many squares they span; each one's."""
    ij = np.empty((len(xy), 2), np.int64)
    for n in range(len(xy)):
        for k in range(2):
            ij[n, k] = math.floor(xy[n, k] / step_m)
    i0 = i1 = ij[0, 0]
    j0 = j1 = ij[0, 1]
    for n in range(1, len(ij)):
        i0, i1 = min(i0, ij[n, 0]), max(i1, ij[n, 0])
        j0, j1 = min(j0, ij[n, 1]), max(j1, ij[n, 1])
    return (i0, j0), (i1 - i0 + 1, j1 - j0 + 1), ij


@kernel
def reach_xy(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lowest and highest x and y of points (N, 2+): (2, 2)."""
    out = np.array([[math.inf, math.inf], [-math.inf, -math.inf]])
    for k in range(len(xy)):
        for c in range(2):
            out[0, c], out[1, c] = min(out[0, c], xy[k, c]), max(out[1, c], xy[k, c])
    return out


def hull_candidates(xy: NDArray[np.floating | np.integer]) -> NDArray[np.float32]:
    """Those of the points (N, 2+) that may be corners of their convex hull: (M, 2), M <= N.

    Whatever lies within the octagon of the points that reach farthest in eight directions can't
    be one (Akl and Toussaint, 1978); that leaves few to sort.
    """
    return _outside_octagon(np.ascontiguousarray(xy, np.float32))


@kernel
def _outside_octagon(xy: NDArray[np.float32]) -> NDArray[np.float32]:
    """Points (N, 2+) that don't lie within the octagon of the farthest."""
    n = len(xy)
    corner = np.zeros(8, np.int64)
    x0 = s0 = y0 = d0 = math.inf
    x1 = s1 = y1 = d1 = -math.inf
    for i in range(n):
        x, y = float(xy[i, 0]), float(xy[i, 1])
        s, d = x + y, y - x
        if x > x1:
            x1, corner[0] = x, i
        if s > s1:
            s1, corner[1] = s, i
        if y > y1:
            y1, corner[2] = y, i
        if d > d1:
            d1, corner[3] = d, i
        if x < x0:
            x0, corner[4] = x, i
        if s < s0:
            s0, corner[5] = s, i
        if y < y0:
            y0, corner[6] = y, i
        if d < d0:
            d0, corner[7] = d, i
    edges = np.zeros((8, 3))
    for k in range(8):
        a, b = corner[k], corner[(k + 1) % 8]
        ax, ay = float(xy[a, 0]), float(xy[a, 1])
        edges[k, 0] = ay - float(xy[b, 1])
        edges[k, 1] = float(xy[b, 0]) - ax
        edges[k, 2] = edges[k, 0] * ax + edges[k, 1] * ay
    out, kept = np.empty((n, 2), np.float32), 0
    for i in range(n):
        x, y = float(xy[i, 0]), float(xy[i, 1])
        within = True
        for k in range(8):
            if edges[k, 0] == 0 and edges[k, 1] == 0:
                continue
            if edges[k, 0] * x + edges[k, 1] * y <= edges[k, 2] + 1e-12:
                within = False
                break
        if not within:
            out[kept, 0], out[kept, 1] = x, y
            kept += 1
    if kept == 0 and n > 0:  # all points may be one
        out[0, 0], out[0, 1] = xy[0, 0], xy[0, 1]
        kept = 1
    return out[:kept]


def smallest_rectangle(
    xy: NDArray[np.floating | np.integer],
) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Centre, sides and turn (degrees) of the smallest rectangle around points (N, 2+), N > 0."""
    (x, y), (length, width), degrees = cv2.minAreaRect(hull_candidates(xy))
    return (float(x), float(y)), (float(length), float(width)), float(degrees)


def box_around(
    footprint_xy: NDArray[np.float64], top_m: float, step_m: float, height_m: float = THICKNESS_M
) -> OrientedBox:
    """Smallest upright box over a footprint of grid squares, its long side along x."""
    (x, y), (length, width), degrees = smallest_rectangle(footprint_xy)
    yaw = math.radians(degrees)
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    yaw = (yaw + math.pi / 2) % math.pi - math.pi / 2
    size = (length + step_m, width + step_m, height_m)
    return OrientedBox((x, y, top_m - height_m / 2), size, yaw)


def sides_from_above(points: NDArray[np.float64]) -> tuple[float, float]:
    """Longer and shorter side of the smallest rectangle around a thing, strays left out, m."""
    xy = points[:: max(1, len(points) // SIDE_SAMPLES), :2]
    centre, _, degrees = smallest_rectangle(xy)
    turn = math.radians(degrees)
    sides = _sides_along(xy, centre, math.cos(turn), math.sin(turn))
    return max(sides), min(sides)


@kernel
def _sides_along(
    xy: NDArray[np.float64], centre: tuple[float, float], cos: float, sin: float
) -> tuple[float, float]:
    """Extent of points (N, 2) along two directions at right angles, strays left out."""
    n = len(xy)
    along, across = np.empty(n), np.empty(n)
    for k in range(n):
        x, y = xy[k, 0] - centre[0], xy[k, 1] - centre[1]
        along[k], across[k] = x * cos + y * sin, y * cos - x * sin
    a0, a1 = percentiles(along, 2.0, 98.0)
    b0, b1 = percentiles(across, 2.0, 98.0)
    return a1 - a0, b1 - b0
