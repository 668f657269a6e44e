"""A body that stands somewhere, as its pixels; how it travels in a `Detection` and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.depth_points import points_of_pixels
from afkb_mapping.image_regions import Region
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma

LEAST_SUPPORT = 0.3
MOST_SUPPORTS = 62
SAMPLES = 500
"""Depths that say how far off a body is."""


class Stand(IntEnum):
    """What a body stands on: a support in sight, one that is hidden, or the floor.

    As a number it is a detection's measure `stand`.
    """

    ON_SUPPORT = 0
    HIDDEN = 1
    ON_FLOOR = 2


@dataclass(frozen=True, slots=True, eq=False)
class Body(Region):
    """Pixels of one body, what it stands on, and how high that is (m); None if it isn't seen.

    Heights of points are those over the support as it is seen, so that a tilt of the view
    doesn't reach them; `slope` (3,) is what was taken off: per metre of x, of y, and at all.
    `noise`: how many times noisier than `depth_sigma` says its view is.
    """

    stand: Stand
    support_height_m: float | None
    slope: tuple[float, float, float] = (0.0, 0.0, 0.0)
    noise: float = field(default=1.0, kw_only=True)

    @property
    def lowest_m(self) -> float:
        """Height of the lowest part in sight, strays left out, m."""
        return percentile(self.points[:, 2], 2.0)

    @property
    def base_m(self) -> float:
        """Height of what it stands on, or where that is hidden of the lowest part in sight, m."""
        return self.lowest_m if self.support_height_m is None else self.support_height_m

    @property
    def range_m(self) -> float:
        """Depth of most of it, m."""
        return percentile(self.depth_m[:: max(1, len(self.depth_m) // SAMPLES)], 50.0)

    @property
    def sigma_m(self) -> float:
        """Standard deviation of its depth, m."""
        return self.noise * depth_sigma(self.range_m)

    def part(self, index: NDArray[np.int64]) -> Body:
        """The body of those of its pixels that have these indexes (M,)."""
        u, v, depth, points = _taken(index, self.u, self.v, self.depth_m, self.points)
        return replace(self, u=u, v=v, depth_m=depth, points=points)


@kernel
def _taken(
    index: NDArray[np.int64],
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    points: NDArray[np.float64],
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32], NDArray[np.float64]]:
    n = len(index)
    us, vs = np.empty(n, np.int32), np.empty(n, np.int32)
    zs, xyz = np.empty(n, np.float32), np.empty((n, 3))
    for m in range(n):
        k = index[m]
        us[m], vs[m], zs[m] = u[k], v[k], depth_m[k]
        xyz[m, 0], xyz[m, 1], xyz[m, 2] = points[k, 0], points[k, 1], points[k, 2]
    return us, vs, zs, xyz


def is_body(detection: Detection) -> bool:
    """Whether a detector cut a body out of its view."""
    return detection.pixels is not None and "stand" in detection.measures


def body_of(detection: Detection, view: View, every: int = 1) -> Body:
    """The body of a detection (`is_body`) of this view.

    `every`: it is thinned to such rows and columns, numbered anew as those of `depth_m[::every,
    ::every]` are; enough of a body that is near.
    """
    assert detection.pixels is not None and view.depth_m is not None
    rows, columns = view.depth_m.shape
    u, v = _thinned(detection.pixels, columns, every)
    depths, points = points_of_pixels(u, v, view)
    m = detection.measures
    slope = (m.get("slope_x", 0.0), m.get("slope_y", 0.0), m.get("slope_offset", 0.0))
    if any(slope):
        points[:, 2] -= slope[0] * points[:, 0] + slope[1] * points[:, 1] + slope[2]
    if every > 1:
        u, v = u // every, v // every
    shape = (-(-rows // every), -(-columns // every))
    stand = Stand(int(m["stand"]))
    return Body(u, v, depths, points, shape, stand, m.get("support_height"), slope)


@kernel
def _thinned(
    pixels: NDArray[np.int32], columns: int, every: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Columns and rows of those of the flat pixels that lie in every so manieth of both."""
    u, v, n = np.empty(len(pixels), np.int32), np.empty(len(pixels), np.int32), 0
    for k in range(len(pixels)):
        row = pixels[k] // columns
        column = pixels[k] - row * columns
        if row % every == 0 and column % every == 0:
            u[n], v[n] = column, row
            n += 1
    return u[:n], v[:n]


def supports_among(earlier: Sequence[Detection]) -> list[Detection]:
    """The supports among a view's detections, highest first; the floor and the smallest left out.

    No more than have a bit each in a 64 bit raster that keeps some for other use.
    """
    chosen = [
        d
        for d in earlier
        if d.affords("SupportAbility", LEAST_SUPPORT)
        and not d.measures.get("is_floor")
        and len(d.footprint_xy) >= 3
    ]
    chosen.sort(key=lambda d: (-d.n_pixels, tuple(d.position_xyz)))
    return sorted(chosen[:MOST_SUPPORTS], key=lambda d: -float(d.position_xyz[2]))
