"""Intrinsic contain-ability: a closed, compact, convex body (paper §II.F: cans, cartons, boxes)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_containers.settings import ContainerSettings
from afkb_mapping.bodies import Body
from afkb_mapping.from_above import hull_candidates
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile, percentiles
from afkb_mapping.trapezoids import membership

SOLIDITY = (0.75, 0.90)
"""Share of its image's convex hull that a body must fill: not at all below, fully above."""
WHOLE = (0.50, 0.70)
"""The same for a hollow body, whose handle or spout stands off: plants and rails fall below."""
SLENDER = 8.0
UNSURE = 1.5
"""Standard deviations of depth by which a thickness must exceed what is thin."""
LEAN_DEG = (9.0, 18.0)
"""Cartons and cans stand upright; what leans further is a frame, a book or a screen."""
NORMAL_2_TO_98 = 4.1
"""Distance between the 2nd and the 98th percentile of normal noise, in standard deviations."""


@dataclass(frozen=True, slots=True)
class Solid:
    """How much a thing is a closed body (`degree`) or one body (`whole`), 0 to 1; measures in m."""

    degree: float
    height_m: float
    thickness_m: float
    length_m: float
    solidity: float
    whole: float


def solid_of(body: Body, length_m: float, settings: ContainerSettings) -> Solid:
    """Judge a thing of a length, seen from above, by height, thickness and convexity."""
    height = percentile(body.points[:, 2], 98.0) - body.base_m
    sigma = body.sigma_m
    width, lean = thickness_and_lean(body.points, sigma)
    fill = image_solidity(body.u, body.v)
    degree = (
        membership(height, settings.solid_height_m)
        * membership(max(height, length_m), settings.max_extent_m)
        * membership(width - UNSURE * sigma, settings.solid_thickness_m)
        * (1.0 - _ramp(lean, LEAN_DEG))
        * _ramp(fill, SOLIDITY)
    )
    if max(height, length_m) > SLENDER * max(width, 1e-3):
        degree = 0.0
    return Solid(degree, height, width, length_m, fill, _ramp(fill, WHOLE))


def _ramp(value: float, limits: tuple[float, float]) -> float:
    return min(max((value - limits[0]) / (limits[1] - limits[0]), 0.0), 1.0)


def thickness_and_lean(points: NDArray[np.float64], sigma_m: float) -> tuple[float, float]:
    """Extent across the plane that fits a thing best, less what noise adds (m), and its lean.

    A frame that leans back is deep when seen from above, and thin across its own plane; the lean
    (degrees from upright) is 0 where that plane lies rather than stands.
    """
    _, axes = np.linalg.eigh(_scatter(points))
    low, high = _ends_along(points, axes[:, 0].copy())
    noise = NORMAL_2_TO_98 * sigma_m
    lean = math.degrees(math.asin(min(abs(float(axes[2, 0])), 1.0)))
    return math.sqrt(max((high - low) ** 2 - noise**2, 0.0)), lean if lean < 40 else 0.0


@kernel
def _scatter(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum (3, 3) of the outer products of points (N, 3) about their mean."""
    centre, total = np.zeros(3), np.zeros((3, 3))
    for n in range(len(points)):
        for k in range(3):
            centre[k] += points[n, k]
    centre /= len(points)
    for n in range(len(points)):
        x, y, z = points[n, 0] - centre[0], points[n, 1] - centre[1], points[n, 2] - centre[2]
        total[0, 0] += x * x
        total[1, 0] += x * y
        total[1, 1] += y * y
        total[2, 0] += x * z
        total[2, 1] += y * z
        total[2, 2] += z * z
    total[0, 1], total[0, 2], total[1, 2] = total[1, 0], total[2, 0], total[2, 1]
    return total


@kernel
def _ends_along(points: NDArray[np.float64], direction: NDArray[np.float64]) -> tuple[float, float]:
    """Where points (N, 3) begin and end along a direction (3,), strays left out."""
    t = np.empty(len(points))
    for n in range(len(points)):
        t[n] = (
            points[n, 0] * direction[0] + points[n, 1] * direction[1] + points[n, 2] * direction[2]
        )
    return percentiles(t, 2.0, 98.0)


def image_solidity(u: NDArray[np.int32], v: NDArray[np.int32]) -> float:
    """Share of the convex hull of its pixels that a thing fills, holes of lost pixels closed."""
    mask = cv2.morphologyEx(
        _mask_of(u, v, extent(u, v)), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8)
    )
    hull = cv2.convexHull(hull_candidates(_row_ends(mask)).astype(np.int32))
    full = np.zeros_like(mask)
    cv2.fillConvexPoly(full, hull, 1)
    return cv2.countNonZero(mask) / max(cv2.countNonZero(full), 1)


@kernel
def _mask_of(
    u: NDArray[np.int32], v: NDArray[np.int32], box: tuple[int, int, int, int]
) -> NDArray[np.uint8]:
    """Mask of pixels, cut out with two pixels around it."""
    u0, v0, u1, v1 = box
    mask = np.zeros((v1 - v0 + 4, u1 - u0 + 4), np.uint8)
    for k in range(len(u)):
        mask[v[k] - v0 + 2, u[k] - u0 + 2] = 1
    return mask


@kernel
def _row_ends(mask: NDArray[np.uint8]) -> NDArray[np.int32]:
    """First and last pixel (u, v) of each row of a mask: (N, 2)."""
    ends = np.empty((2 * mask.shape[0], 2), np.int32)
    n = 0
    for v in range(mask.shape[0]):
        first = last = -1
        for u in range(mask.shape[1]):
            if mask[v, u]:
                first = u if first < 0 else first
                last = u
        if first >= 0:
            ends[n, 0], ends[n, 1], ends[n + 1, 0], ends[n + 1, 1] = first, v, last, v
            n += 2
    return ends[:n]
