"""Straight pieces of one laser scan: split at corners, then fitted."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LaserScan
from afkb_mapping.kernels import kernel
from afkb_mapping.placing.scan_surface import pieces_of

Array = NDArray[np.float64]
Index = NDArray[np.intp]

SPLIT_M = 0.05
"""A point this far from the chord makes a corner: range noise of 1 cm stays below it."""
MAX_GAP_M = 0.5
"""Between beams further apart than this a door may stand open, so a piece ends there."""
MIN_LENGTH_M = 0.3
"""Shorter pieces bound nothing: legs, bins, edges."""
MIN_BEAMS = 6
"""Fewer beams are in line by chance."""
MAX_RMS_M = 0.025
"""Greatest spread about the line: what is rougher (people, plants, curtains) is no flat bound."""


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """`ends_xy` (2, 2) m in the laser frame, its beams, and their rms distance from it (m)."""

    ends_xy: Array
    n_beams: int
    rms_m: float
    range_m: float

    @property
    def length_m(self) -> float:
        """Distance between the ends, m."""
        (ax, ay), (bx, by) = self.ends_xy
        return math.hypot(bx - ax, by - ay)


def segments_of(scan: LaserScan) -> list[Segment]:
    """The straight pieces of a scan, in beam order."""
    points = scan.points_xy
    if len(points) < MIN_BEAMS:
        return []
    steps = np.diff(points, axis=0)
    apart = (np.hypot(steps[:, 0], steps[:, 1]) > MAX_GAP_M) | (np.diff(pieces_of(points)) > 0)
    rows = _lines(points, np.flatnonzero(apart) + 1)
    return [Segment(r[:4].reshape(2, 2), int(r[4]), float(r[5]), float(r[6])) for r in rows]


@kernel
def _lines(points: Array, starts: Index) -> Array:
    """Rows of two ends (x, y, x, y), beams, rms and range of the parts of pieces that are straight.

    A piece begins at each of `starts`. It is split where it is furthest from the chord (Ramer,
    Douglas and Peucker); a corner belongs to both parts.
    """
    n = len(points)
    rows, count = np.empty((n // (MIN_BEAMS - 1) + 1, 7)), 0
    stop = np.empty(n, np.intp)
    for piece in range(len(starts) + 1):
        first = 0 if piece == 0 else starts[piece - 1]
        end = n if piece == len(starts) else starts[piece]
        # The parts still to be looked at, by where they stop: those that come first are on top.
        stop[0], left = end - 1, 1
        while left:
            last = stop[left - 1]
            if last - first + 1 < MIN_BEAMS:
                first, left = last, left - 1
                continue
            corner = _corner(points, first, last)
            if corner >= 0:
                stop[left], left = corner, left + 1
                continue
            if _fit(points, first, last, rows[count]):
                count += 1
            first, left = last, left - 1
    return rows[:count]


@kernel
def _corner(points: Array, first: int, last: int) -> int:
    """The point furthest from the chord of a part, if it is a corner; else -1."""
    ax, ay = points[first]
    dx, dy = points[last, 0] - ax, points[last, 1] - ay
    chord = math.hypot(dx, dy)
    best, furthest = -1, SPLIT_M
    for k in range(first + 1, last):
        x, y = points[k, 0] - ax, points[k, 1] - ay
        off = abs(x * dy - y * dx) / chord if chord > 0 else math.hypot(x, y)
        if off > furthest:
            best, furthest = k, off
    return best


@kernel
def _fit(points: Array, first: int, last: int, row: Array) -> bool:
    """Total least squares line through a part, into a row; False where it is no bound."""
    n = last - first + 1
    mx, my, nearest = 0.0, 0.0, np.inf
    for k in range(first, last + 1):
        x, y = points[k]
        mx, my, nearest = mx + x / n, my + y / n, min(nearest, math.hypot(x, y))
    xx, xy, yy = 0.0, 0.0, 0.0
    for k in range(first, last + 1):
        x, y = points[k, 0] - mx, points[k, 1] - my
        xx, xy, yy = xx + x * x / n, xy + x * y / n, yy + y * y / n
    angle = 0.5 * math.atan2(2 * xy, xx - yy)
    ux, uy = math.cos(angle), math.sin(angle)
    if ux * (points[last, 0] - points[first, 0]) + uy * (points[last, 1] - points[first, 1]) < 0:
        ux, uy = -ux, -uy
    rms = math.sqrt(max((xx + yy) / 2 - math.hypot((xx - yy) / 2, xy), 0.0))
    low, high = np.inf, -np.inf
    for k in range(first, last + 1):
        reach = ux * (points[k, 0] - mx) + uy * (points[k, 1] - my)
        low, high = min(low, reach), max(high, reach)
    row[0], row[1], row[2], row[3] = mx + low * ux, my + low * uy, mx + high * ux, my + high * uy
    row[4], row[5], row[6] = n, rms, nearest
    return high - low >= MIN_LENGTH_M and rms <= MAX_RMS_M
