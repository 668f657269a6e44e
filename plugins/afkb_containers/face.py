"""The plane that most of a body lies in, and how much narrower a body is above than below."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile, percentiles

FACE_M, FACE_SIGMAS, FACE_FITS = 0.006, 2.5, 3
"""Points this near to a plane are on it; it is fitted to those so many times."""
NARROWER = (0.15, 0.30)
"""How much narrower the upper third of a body is than its lower: strays do the first, bottles and
lamps are beyond the second."""
ENDS = 6.0
"""Percent of points at the upper and the lower end that are left out."""


@kernel
def narrowing_deg(points: NDArray[np.float64], normal: NDArray[np.float64]) -> float:
    """How far the front of a round body leans that is as much narrower above as these points are.

    By the spread of its lower and of its upper third across the sight; 0 if it grows wider.
    """
    x, y = -normal[1], normal[0]
    flat = max(math.hypot(x, y), 1e-9)
    low, high = percentiles(points[:, 2], ENDS, 100.0 - ENDS)
    third = max((high - low) / 3.0, 1e-6)
    sums, half = np.zeros((2, 3)), np.zeros(2)
    for k in range(len(points)):
        part = (points[k, 2] - low) / third
        if 1.0 < part < 2.0:
            continue
        across = (points[k, 0] * x + points[k, 1] * y) / flat
        s = sums[0 if part <= 1.0 else 1]
        s[0] += 1.0
        s[1] += across
        s[2] += across * across
    for i in range(2):
        if sums[i, 0] < 2:
            return 0.0
        mean = sums[i, 1] / sums[i, 0]
        half[i] = math.sqrt(3.0 * max(sums[i, 2] / sums[i, 0] - mean * mean, 0.0))
    share = 1.0 - half[1] / max(half[0], 1e-6)
    sure = min(max((share - NARROWER[0]) / (NARROWER[1] - NARROWER[0]), 0.0), 1.0)
    return float(sure * math.degrees(math.atan2(half[0] - half[1], 2.0 * third)))


@kernel
def face_of(
    points: NDArray[np.float64], normal: NDArray[np.float64], sigma_m: float
) -> tuple[float, NDArray[np.float64]]:
    """Share of points that lie in a band about one plane, and its normal (3,).

    It is fitted to what lies in the band alone, from a first normal through the middle.
    """
    band_m = max(FACE_M, FACE_SIGMAS * sigma_m)
    n = len(points)
    near, t = np.ones(n, np.bool_), np.empty(n)
    for fit in range(FACE_FITS + 1):
        if fit > 0:
            scatter = _covariance(points, near)
            normal = np.linalg.eigh(scatter)[1][:, 0].copy()
        for k in range(n):
            t[k] = points[k, 0] * normal[0] + points[k, 1] * normal[1] + points[k, 2] * normal[2]
        middle = percentile(t[near], 50.0)
        for k in range(n):
            near[k] = abs(t[k] - middle) < band_m
    return near.sum() / n, normal


@kernel
def _covariance(points: NDArray[np.float64], near: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Covariance (3, 3) of those of the points that are near."""
    centre, total, count = np.zeros(3), np.zeros((3, 3)), 0
    for k in range(len(points)):
        if near[k]:
            count += 1
            for i in range(3):
                centre[i] += points[k, i]
    centre /= max(count, 1)
    for k in range(len(points)):
        if near[k]:
            for i in range(3):
                for j in range(3):
                    total[i, j] += (points[k, i] - centre[i]) * (points[k, j] - centre[j])
    return total / max(count, 1)
