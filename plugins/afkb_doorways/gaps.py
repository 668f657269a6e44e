"""Gaps in what is seen around: two edges with free space behind the line between them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.placing.scan_surface import pieces_of

Array = NDArray[np.float64]
Index = NDArray[np.intp]

BEYOND_M = 0.6
"""So far behind the gap it must be free: room for a robot or a person to get through."""
BEFORE_M = 0.1
"""What stands this far before the line, or further, stands in the way."""
DEEP, BLOCKED = 0.7, 0.1
"""Least share of the beams through a gap that go on beyond it, and greatest that end before it."""
JAMB_M = 0.4
"""Piece of wall beside the gap that is looked at: its direction, and where it comes nearest to the
other jamb (seen at a slant, a jamb shows its inner face first)."""
SHORTEST_M, LONGEST_M = 0.12, 1.0
"""A shorter piece is a leg or an edge, and no jamb; of a longer one no more is measured."""
SQUARE_RAD = (math.radians(15.0), math.radians(30.0))
"""A jamb runs along the gap or straight across it, but for the first; beyond the second it is none.
"""
FORTH, BACK = np.int64(1), np.int64(-1)
"""Steps along the edges; of a type, as literals are not, so that kernels are compiled once."""
WIDEST_ANGLE = math.radians(160.0)
"""Wider than this the sensor stands between the jambs, and knows nothing of what is beyond."""


@dataclass(frozen=True, slots=True, eq=False)
class Beams:
    """What is known around one point, by bearing, counter-clockwise; map frame, m, rad.

    - `reach_m` (N,): how far the way is seen to be free; 0 where nothing is known.
    - `solid` (N,): whether it ends there at an obstacle.
    """

    center_xy: Array
    bearings: Array
    reach_m: Array
    solid: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Gap:
    """A gap as one sensor sees it, map frame, m.

    - `jambs_xy` (2, 2): the right one first, as seen from the sensor.
    - `deep`: share of the beams between them that go on beyond; `n_beams`: how many there are.
    - `square`: 0 to 1, how well both jambs run along the gap or straight across it.
    - `lengths_m`: of the straight piece of wall that each jamb ends, up to `LONGEST_M`.
    - `sides`: points (M, 2) of the first `JAMB_M` of each of them.
    """

    jambs_xy: Array
    deep: float
    n_beams: int
    square: float
    lengths_m: tuple[float, float]
    sides: tuple[Array, Array]

    @property
    def width_m(self) -> float:
        """From jamb to jamb, m."""
        return math.dist(*self.jambs_xy.tolist())

    @property
    def middle_xy(self) -> Array:
        """(2,) m."""
        middle: Array = (self.jambs_xy[0] + self.jambs_xy[1]) / 2
        return middle


def gaps_in(beams: Beams, narrowest_m: float, widest_m: float) -> list[Gap]:
    """All gaps of a width between these, in order of bearing; the same edge may end several."""
    at = np.flatnonzero(beams.solid)
    if len(at) < 4:
        return []
    r, angle = beams.reach_m[at], beams.bearings[at]
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    starts = np.flatnonzero(np.diff(pieces_of(points), prepend=-1))
    ends = np.append(starts[1:], len(points))
    rows = _gaps(points, at, starts, ends, beams.bearings, beams.reach_m, narrowest_m, widest_m)
    placed = points + beams.center_xy
    return [_gap(row, placed) for row in rows.tolist()]


def _gap(row: list[float], points: Array) -> Gap:
    deep, n_beams, square, *lengths = row[:5]
    i, i_last, j, j_last = map(int, row[5:])
    return Gap(
        np.stack([points[i], points[j]]),
        deep,
        int(n_beams),
        square,
        (lengths[0], lengths[1]),
        (points[i_last : i + 1][::-1].copy(), points[j : j_last + 1]),
    )


@kernel
def _gaps(
    points: Array,
    at: Index,
    starts: Index,
    ends: Index,
    bearings: Array,
    reach: Array,
    narrowest: float,
    widest: float,
) -> Array:
    """Rows of deep share, beams, squareness, two lengths, and first and last point of each side."""
    n = len(starts)
    rows = np.empty((n * 8, 9))
    count = 0
    for a in range(n):
        if _apart(points[starts[a]], points[ends[a] - 1]) < SHORTEST_M:
            continue
        for step in range(1, n):
            b = (a + step) % n
            first, last = at[ends[a] - 1], at[starts[b]]
            if (bearings[last] - bearings[first]) % (2 * math.pi) > WIDEST_ANGLE:
                break
            if _apart(points[starts[b]], points[ends[b] - 1]) < SHORTEST_M:
                continue
            i, j = ends[a] - 1, starts[b]
            if _apart(points[i], points[j]) > widest + JAMB_M:
                continue
            j = _nearest(points, i, starts[b], ends[b], starts[b])
            i = _nearest(points, j, starts[a], ends[a], ends[a] - 1)
            width = _apart(points[i], points[j])
            if width < narrowest or width > widest or count == len(rows):
                continue
            length_a, i_last, square_a = _side(points, i, starts[a] - 1, BACK, points[j])
            length_b, j_last, square_b = _side(points, j, ends[b], FORTH, points[i])
            if min(square_a, square_b) <= 0 or min(length_a, length_b) < SHORTEST_M:
                continue
            deep, blocked, beams = _through(points[i], points[j], first, last, bearings, reach)
            if beams and deep >= DEEP and blocked <= BLOCKED:
                rows[count, 0], rows[count, 1] = deep, beams
                rows[count, 2] = square_a * square_b
                rows[count, 3], rows[count, 4] = length_a, length_b
                rows[count, 5], rows[count, 6] = i, i_last
                rows[count, 7], rows[count, 8] = j, j_last
                count += 1
    return rows[:count]


@kernel
def _side(points: Array, jamb: int, stop: int, step: int, other: Array) -> tuple[float, int, float]:
    """Length of the piece from a jamb on, last point of its first part, and how square that is.

    A jamb may bend soon, as a door's frame does: the better of its first half and all of it counts.
    """
    length, k_last, k = 0.0, jamb, jamb
    while k != stop:
        off = _apart(points[k], points[jamb])
        if off > LONGEST_M:
            break
        length = max(length, off)
        if off <= JAMB_M:
            k_last = k
        k += step
    half = _square(points, jamb, k_last, step, other, JAMB_M / 2)
    whole = _square(points, jamb, k_last, step, other, JAMB_M)
    return length, k_last, max(half, whole)


@kernel
def _square(points: Array, jamb: int, last: int, step: int, other: Array, within: float) -> float:
    """How nearly the first piece of a jamb runs along the gap or straight across it, 0 to 1."""
    n, mx, my, xx, xy, yy = 0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(jamb, last + step, step):
        if _apart(points[k], points[jamb]) <= within:
            dx, dy = points[k, 0] - points[jamb, 0], points[k, 1] - points[jamb, 1]
            n += 1
            mx, my = mx + dx, my + dy
            xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
    if n < 3:
        return 0.5
    cxx, cxy, cyy = xx / n - mx * mx / n**2, xy / n - mx * my / n**2, yy / n - my * my / n**2
    along = 0.5 * math.atan2(2 * cxy, cxx - cyy)
    gap = math.atan2(other[1] - points[jamb, 1], other[0] - points[jamb, 0])
    turn = (along - gap) % (math.pi / 2)
    off_square = min(turn, math.pi / 2 - turn)
    least, most = SQUARE_RAD
    return min(1.0, max(0.0, (most - off_square) / (most - least)))


@kernel
def _apart(p: Array, q: Array) -> float:
    return float(math.hypot(p[0] - q[0], p[1] - q[1]))


@kernel
def _nearest(points: Array, to: int, first: int, stop: int, end: int) -> int:
    """Of a piece (first to stop) the point nearest to another, within a jamb of its end."""
    best, least = end, np.inf
    for k in range(first, stop):
        if _apart(points[k], points[end]) <= JAMB_M:
            off = _apart(points[k], points[to])
            if off < least:
                best, least = k, off
    return best


@kernel
def _through(
    p: Array, q: Array, first: int, last: int, bearings: Array, reach: Array
) -> tuple[float, float, int]:
    """Of the beams between two jambs the shares that go on beyond and that end before the line."""
    n = len(bearings)
    total, deep, blocked = 0, 0, 0
    cross = p[0] * q[1] - p[1] * q[0]
    k = (first + 1) % n
    while k != last:
        facing = math.cos(bearings[k]) * (q[1] - p[1]) - math.sin(bearings[k]) * (q[0] - p[0])
        k_now, k = k, (k + 1) % n
        if abs(facing) < 1e-6:
            continue
        line = cross / facing
        if line <= 0:
            continue
        total += 1
        deep += reach[k_now] > line + BEYOND_M
        blocked += 0 < reach[k_now] < line - BEFORE_M
    return (deep / total, blocked / total, total) if total else (0.0, 0.0, 0)
