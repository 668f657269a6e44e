"""Surface of a laser scan: its points with normals, and the map of such points that scans match.

Everything is planar (seen from above), metres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LaserScan

Points = NDArray[np.float64]

WINDOWS_M = (0.12, 0.4)
"""Half lengths of wall that a normal is fitted to: over the first, noise of 1 cm tilts it by a few
degrees; the second is for points where a noisier laser (3 cm) shows no line over the first."""
WINDOW_BEAMS = 2
"""Least number of neighbours on either side; where beams are sparse the window is that long."""
GAP_M = 0.25
"""Neighbouring beams further apart than this may lie on different things (a leg, a wall behind),"""
GAP_RATIO = 2.5
"""and do, if they are also this much further apart than the beams beside them: along a wall seen
at a slant the spacing grows, but evenly."""
FLATNESS = 0.15
"""Greatest ratio of spread across to spread along a window that still counts as a line,"""
ROUGHNESS_M = 0.03
"""and greatest spread across: the range noise of common lasers."""
GRAZING = 0.05
"""Sine of the least angle between beam and surface; below it the "surface" is an edge's mixed
ranges, strung out along the beam."""
CELL_M = 0.05
"""Cell within which the map averages points: about the beam spacing at 5 m, below a wall's depth"""


@dataclass(frozen=True, slots=True, eq=False)
class SurfacePoints:
    """`points_xy` (N, 2) m and `normals_xy` (N, 2), unit, facing the sensor."""

    points_xy: Points
    normals_xy: Points

    def __len__(self) -> int:
        return len(self.points_xy)

    def near(self, center_xy: Points, radius_m: float) -> SurfacePoints:
        """The part within a radius of a point, m."""
        close = ((self.points_xy - center_xy) ** 2).sum(axis=1) < radius_m**2
        return SurfacePoints(self.points_xy[close], self.normals_xy[close])

    def moved(self, R: Points, t: Points) -> SurfacePoints:
        """The same surface rotated by R (2, 2), then shifted by t (2,)."""
        return SurfacePoints(self.points_xy @ R.T + t, self.normals_xy @ R.T)


def surface_of(scan: LaserScan) -> SurfacePoints:
    """The returned points that lie on something locally straight, in the laser frame.

    A line is fitted to the neighbours of each beam by running sums over the arc length, so that
    the cost does not depend on the window.
    """
    points = scan.points_xy
    if len(points) < 3:
        return SurfacePoints(np.empty((0, 2)), np.empty((0, 2)))
    normals, straight = _fit_lines(points, *_windows(points, WINDOWS_M[0]))
    if not straight.all():
        wide_normals, wide_straight = _fit_lines(points, *_windows(points, WINDOWS_M[1]))
        normals = np.where(straight[:, None], normals, wide_normals)
        straight |= wide_straight
    facing = -(normals * points).sum(axis=1) / np.linalg.norm(points, axis=1)
    normals *= np.where(facing < 0, -1.0, 1.0)[:, None]
    straight &= np.abs(facing) > GRAZING
    return SurfacePoints(points[straight], normals[straight])


def pieces_of(points: Points) -> NDArray[np.intp]:
    """Number of the piece of surface that each point (N, 2), in beam order, belongs to, from 0."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    padded = np.concatenate([[np.inf], steps, [np.inf]])
    beside = np.minimum(padded[:-2], padded[2:])
    torn = (steps > GAP_M) & (steps > GAP_RATIO * beside)
    return np.concatenate([[0], np.cumsum(torn)])


def _windows(points: Points, half_m: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Half-open index ranges of the points that share each point's piece of surface."""
    piece = pieces_of(points)
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    index = np.arange(len(points))
    first = np.minimum(np.searchsorted(arc, arc - half_m), index - WINDOW_BEAMS)
    last = np.maximum(np.searchsorted(arc, arc + half_m, side="right"), index + WINDOW_BEAMS + 1)
    return (
        np.maximum(first, np.searchsorted(piece, piece)),
        np.minimum(last, np.searchsorted(piece, piece, side="right")),
    )


def _fit_lines(
    points: Points, first: NDArray[np.intp], last: NDArray[np.intp]
) -> tuple[Points, NDArray[np.bool_]]:
    """Normals (N, 2) of total least squares lines, and whether each window is a line at all."""
    x, y = points.T
    moments = np.stack([x, y, x * x, x * y, y * y])
    sums = np.concatenate([np.zeros((5, 1)), np.cumsum(moments, axis=1)], axis=1)
    count = (last - first).astype(np.float64)
    mx, my, xx, xy, yy = (sums[:, last] - sums[:, first]) / count
    cxx, cxy, cyy = xx - mx * mx, xy - mx * my, yy - my * my
    half_gap = np.hypot((cxx - cyy) / 2, cxy)
    large = (cxx + cyy) / 2 + half_gap
    small = np.maximum((cxx + cyy) / 2 - half_gap, 0.0)
    along = 0.5 * np.arctan2(2 * cxy, cxx - cyy)
    normals = np.column_stack([-np.sin(along), np.cos(along)])
    straight = (count >= 3) & (small < FLATNESS**2 * large) & (small < ROUGHNESS_M**2)
    return normals, straight


class SurfaceMap:
    """Surface points of all scans so far, averaged per cell and side; grows with what is seen."""

    def __init__(self) -> None:
        self._index: dict[tuple[int, int, int], int] = {}
        self._sums = np.zeros((1024, 5))

    def __len__(self) -> int:
        return len(self._index)

    def add(self, surface: SurfacePoints) -> None:
        """Average in a scan's points, given in the map frame."""
        points, normals = surface.points_xy, surface.normals_xy
        rows = self._rows_of(points, normals)
        values = np.column_stack([points, normals, np.ones(len(points))])
        np.add.at(self._sums, rows, values)

    def _rows_of(self, points: Points, normals: Points) -> NDArray[np.intp]:
        """Row of each point's cell; both sides of a thin wall have rows of their own."""
        cells = np.floor(points / CELL_M).astype(np.int64)
        facing = np.round(np.arctan2(normals[:, 1], normals[:, 0]) / (np.pi / 2)).astype(int) % 4
        index = self._index
        keys = zip(cells[:, 0].tolist(), cells[:, 1].tolist(), facing.tolist(), strict=True)
        rows = np.array([index.setdefault(key, len(index)) for key in keys], dtype=np.intp)
        while len(index) > len(self._sums):
            self._sums = np.concatenate([self._sums, np.zeros_like(self._sums)])
        return rows

    def near(self, center_xy: Points, radius_m: float) -> SurfacePoints:
        """The map's points within a radius: what a scan taken there can see."""
        sums = self._sums[: len(self._index)]
        points = sums[:, :2] / sums[:, 4:]
        close = ((points - center_xy) ** 2).sum(axis=1) < radius_m**2
        normals = sums[close, 2:4]
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return SurfacePoints(points[close], normals / np.maximum(length, 1e-9))
