"""Which known wall a segment continues or repeats."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

Array = NDArray[np.float64]

OFFSET_M = 0.08
"""Segments whose ends lie this near one line are one wall; the two sides of a wall are further."""
GATE = 9.21
"""Of squared differences over their variances: 99 % of two measurements of one line differ by less
(chi-squared, offset and direction)."""
GAP_M = 0.3
"""Ends this near are one wall with something before it; a doorway is wider."""


@kernel
def best_fit(walls: Array, variances: Array, segment: Array, segment_variances: Array) -> int:
    """Index of the wall (N, 2, 2) that a segment (2, 2) fits best, m; -1 where it fits none.

    `variances` (N, 2) and (2,): of the lines' offsets (m²) and directions (rad²). Both are held
    against the line of the longer one, as a short one's direction is worth little.
    """
    best, least = -1, GATE
    sx, sy = segment[1, 0] - segment[0, 0], segment[1, 1] - segment[0, 1]
    length = math.hypot(sx, sy)
    for n in range(len(walls)):
        wx, wy = walls[n, 1, 0] - walls[n, 0, 0], walls[n, 1, 1] - walls[n, 0, 1]
        wall_length = math.hypot(wx, wy)
        if wall_length >= length:
            offset, farthest, gap, lever = _against_line(walls[n], wall_length, segment)
        else:
            offset, farthest, gap, lever = _against_line(segment, length, walls[n])
        if farthest >= OFFSET_M or gap >= GAP_M:
            continue
        angle = math.asin(min(abs(wx * sy - wy * sx) / (wall_length * length), 1.0))
        turn_variance = variances[n, 1] + segment_variances[1]
        # The further a short segment lies along a long one, the more its direction matters.
        variance = variances[n, 0] + segment_variances[0] + lever * lever * turn_variance
        apart = offset * offset / variance + angle * angle / turn_variance
        if apart < least:
            best, least = n, apart
    return best


@kernel
def _against_line(base: Array, length: float, other: Array) -> tuple[float, float, float, float]:
    """How a segment lies to a longer one (2, 2) of that length, m.

    Offset of its middle and of its farther end from the longer one's line; gap between them along
    that line; distance of their middles along it.
    """
    ax, ay = (base[1, 0] - base[0, 0]) / length, (base[1, 1] - base[0, 1]) / length
    x0, y0 = other[0, 0] - base[0, 0], other[0, 1] - base[0, 1]
    x1, y1 = other[1, 0] - base[0, 0], other[1, 1] - base[0, 1]
    across0, across1 = y0 * ax - x0 * ay, y1 * ax - x1 * ay
    along0, along1 = x0 * ax + y0 * ay, x1 * ax + y1 * ay
    gap = max(min(along0, along1) - length, -max(along0, along1), 0.0)
    farthest = max(abs(across0), abs(across1))
    return abs(across0 + across1) / 2, farthest, gap, abs((along0 + along1) / 2 - length / 2)
