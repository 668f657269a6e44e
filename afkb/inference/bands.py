"""Continuous measures as bands, and how a category's typical range fills them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SIZE_EDGES_M: Array = np.asarray(np.geomspace(0.015, 4.0, 18), dtype=np.float64)
"""Edges between the bands of an extent, m; each band is 1.39 times as wide as the one before."""
TOP_EDGES_M: Array = 0.05 * np.arange(1, 46, dtype=np.float64)
"""Edges between the bands of the height of a top above the floor, m."""


def band_of(value: float, edges: Array) -> int:
    """Index of the band that holds the value, 0 to len(edges).

    It is told to 0.1 mm, as a map states it: what the map says falls into the same band.
    """
    return int(np.searchsorted(edges, round(value, 4), side="right"))


def normal_bands(mean: float, sd: float, edges: Array) -> Array:
    """Probability of each band, (len(edges) + 1,), under a normal distribution."""
    scaled = (edges - mean) / (sd * math.sqrt(2.0))
    cumulative = np.array([0.0, *(0.5 * (1.0 + math.erf(v)) for v in scaled), 1.0])
    return np.diff(cumulative)


def size_bands(low_m: float, high_m: float, spread: float, noise: float, blur_m: float) -> Array:
    """Probability of each size band for a typical range, m: log-normal, its ends `spread` sd off.

    `noise`: standard deviation of the logarithm of one measurement, which is on average longer by
    `blur_m`.
    """
    low, high = math.log(low_m + blur_m), math.log(high_m + blur_m)
    sd = math.hypot((high - low) / (2.0 * spread), noise)
    return _smoothed(normal_bands((low + high) / 2.0, sd, np.log(SIZE_EDGES_M)))


def top_bands(low_m: float, high_m: float, spread: float, noise_m: float) -> Array:
    """Probability of each band of the height of a top, for a typical range, m: normal."""
    sd = math.hypot((high_m - low_m) / (2.0 * spread), noise_m)
    return _smoothed(normal_bands((low_m + high_m) / 2.0, sd, TOP_EDGES_M))


def board_bands(highest_m: float, noise_m: float) -> Array:
    """Probability of each band of the height of a board of furniture that is so high, m: even."""
    below = np.clip(
        (highest_m + noise_m - np.array([0.0, *TOP_EDGES_M])) / TOP_EDGES_M[0], 0.0, 1.0
    )
    return _smoothed(below / below.sum())


def even_bands(edges: Array) -> Array:
    """The same probability for every band."""
    return np.full(len(edges) + 1, 1.0 / (len(edges) + 1))


def _smoothed(bands: Array) -> Array:
    """A hundredth spread evenly: no typical range is so sure that it rules a size out."""
    return 0.99 * bands + 0.01 / len(bands)
