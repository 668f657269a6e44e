"""Measures of texture from colour: one dominant direction, or a grid of two."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

DIRECTIONS = 8
"""Bins of the direction of change, over half a turn."""
LEAST_PIXELS = 200
LEAST_CHANGE = 8.0
"""Mean change, in grey levels of 255 a pixel, under which a body has no texture."""


def texture_measures(
    pixels: NDArray[np.int32], color: NDArray[np.uint8] | None
) -> dict[str, float]:
    """How directed the changes of colour are on a body's pixels (flat indexes); see measures.csv.

    `color`: (H, W, 3), registered to depth; without it nothing is said. 1 where nothing changes.
    """
    if color is None or len(pixels) < LEAST_PIXELS:
        return {}
    v, u = pixels // color.shape[1], pixels % color.shape[1]
    v0, v1, u0, u1 = v.min(), v.max() + 1, u.min(), u.max() + 1
    own = np.zeros((v1 - v0, u1 - u0), np.uint8)
    own[v - v0, u - u0] = 1
    # the outline of a body is no texture of it
    own = cv2.erode(own, np.ones((5, 5), np.uint8), borderValue=0)
    inside = own > 0
    if inside.sum() < LEAST_PIXELS:
        return {}
    grey = cv2.cvtColor(np.ascontiguousarray(color[v0:v1, u0:u1]), cv2.COLOR_RGB2GRAY)
    along = cv2.Sobel(grey, cv2.CV_32F, 1, 0)[inside] / 8.0
    down = cv2.Sobel(grey, cv2.CV_32F, 0, 1)[inside] / 8.0
    strength = np.hypot(along, down)
    if strength.mean() < LEAST_CHANGE:
        return {"dominant_orientation_ratio": 1.0, "grid_ratio": 1.0}
    bins = np.round(np.arctan2(down, along) % np.pi / np.pi * DIRECTIONS).astype(np.int64)
    sums = np.bincount(bins % DIRECTIONS, weights=strength**2, minlength=DIRECTIONS)
    return _ratios(sums / sums.sum())


def _ratios(shares: NDArray[np.float64]) -> dict[str, float]:
    """From the shares of change by direction: along the main one, across it, and between both."""
    main, half = int(shares.argmax()), DIRECTIONS // 2
    across = shares[(main + half) % DIRECTIONS]
    between = (shares[(main + half // 2) % DIRECTIONS] + shares[main - half // 2]) / 2
    least = 1e-3
    return {
        "dominant_orientation_ratio": float(shares[main] / max(across, least)),
        "grid_ratio": float(min(shares[main], across) / max(between, least)),
    }
