"""Surface of a laser scan: its points with normals.

Everything is planar (seen from above), metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LaserScan

Points = NDArray[np.float64]

RANGE_SIGMA_M = 0.02
"""How far a beam's end strays from the mapped surface: range noise and cell averaging together."""
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


@dataclass(frozen=True, slots=True, eq=False)
class SurfacePoints:
    """What stands upright, seen from above.

    - `points_xy` (N, 2) m and `normals_xy` (N, 2), unit, facing the sensor.
    - `level` (N,) int: layer of height; points of different layers never match each other.
    - `sigma_m` (N,): standard deviation of a point across its surface.
    """

    points_xy: Points
    normals_xy: Points
    level: NDArray[np.intp]
    sigma_m: Points

    @classmethod
    def of_laser(cls, points_xy: Points, normals_xy: Points) -> SurfacePoints:
        """What a laser met: all in one layer, as sure as lasers are."""
        count = len(points_xy)
        return cls(points_xy, normals_xy, np.zeros(count, np.intp), np.full(count, RANGE_SIGMA_M))

    def __len__(self) -> int:
        return len(self.points_xy)

    def where(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> SurfacePoints:
        """Some of the points."""
        level, sigma_m = self.level[chosen], self.sigma_m[chosen]
        return SurfacePoints(self.points_xy[chosen], self.normals_xy[chosen], level, sigma_m)

    def near(self, center_xy: Points, radius_m: float) -> SurfacePoints:
        """The part within a radius of a point, m."""
        return self.where(((self.points_xy - center_xy) ** 2).sum(axis=1) < radius_m**2)

    def moved(self, R: Points, t: Points) -> SurfacePoints:
        """The same surface rotated by R (2, 2), then shifted by t (2,)."""
        points, normals = self.points_xy @ R.T + t, self.normals_xy @ R.T
        return SurfacePoints(points, normals, self.level, self.sigma_m)


def no_surface() -> SurfacePoints:
    """No points at all."""
    return SurfacePoints.of_laser(np.empty((0, 2)), np.empty((0, 2)))


def joined(parts: Sequence[SurfacePoints]) -> SurfacePoints:
    """All points of several surfaces in one frame."""
    return SurfacePoints(
        np.concatenate([p.points_xy for p in parts]),
        np.concatenate([p.normals_xy for p in parts]),
        np.concatenate([p.level for p in parts]),
        np.concatenate([p.sigma_m for p in parts]),
    )


def surface_of(scan: LaserScan) -> SurfacePoints:
    """The returned points that lie on something locally straight, in the laser frame.

    A line is fitted to the neighbours of each beam by running sums over the arc length, so that
    the cost does not depend on the window.
    """
    points = scan.points_xy
    level = np.zeros(len(points), np.intp)
    return surface_of_rows(points, level, np.full(len(points), RANGE_SIGMA_M))


def surface_of_rows(points: Points, level: NDArray[np.intp], sigma_m: Points) -> SurfacePoints:
    """The same of points (N, 2) about the sensor that lie row by row, by `level`, each in order."""
    if len(points) < 3:
        return no_surface()
    piece = pieces_of(points, np.diff(level) != 0)
    normals, straight = _fit_lines(points, *_windows(points, piece, WINDOWS_M[0]))
    if not straight.all():
        wide_normals, wide_straight = _fit_lines(points, *_windows(points, piece, WINDOWS_M[1]))
        normals = np.where(straight[:, None], normals, wide_normals)
        straight |= wide_straight
    facing = -(normals * points).sum(axis=1) / np.linalg.norm(points, axis=1)
    normals *= np.where(facing < 0, -1.0, 1.0)[:, None]
    straight &= np.abs(facing) > GRAZING
    return SurfacePoints(points, normals, level, sigma_m).where(straight)


def pieces_of(points: Points, apart: NDArray[np.bool_] | None = None) -> NDArray[np.intp]:
    """Number of the piece of surface that each point (N, 2), in beam order, belongs to, from 0.

    `apart` (N - 1,): neighbours that are known not to lie on one piece.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    padded = np.concatenate([[np.inf], steps, [np.inf]])
    beside = np.minimum(padded[:-2], padded[2:])
    torn = (steps > GAP_M) & (steps > GAP_RATIO * beside)
    if apart is not None:
        torn |= apart
    return np.concatenate([[0], np.cumsum(torn)])


def _windows(
    points: Points, piece: NDArray[np.intp], half_m: float
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Half-open index ranges of the points that share each point's piece of surface."""
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
