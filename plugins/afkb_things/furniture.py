"""Bodies that are parts of furniture: legs, side panels, backs."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OrientedBox
from afkb_mapping.bodies import Body, Stand
from afkb_mapping.from_above import sides_from_above
from afkb_mapping.order_statistics import percentiles
from afkb_things.supports import RASTER_M, Supports

THIN_M = 0.06
"""Boards and slats are thinner than this."""
LEG_M = 0.10
"""Legs are narrower than this."""
ALONG = 0.75
"""A panel or a back is as long as this share of the edge that it stands on, or more."""
EDGE_M = 0.06
"""So near to the edge of what it stands on is a panel or a back."""
ABOVE_M = 0.02
"""What carries a support ends below it, but for the noise."""
LARGER = 4.0
"""Times its own area, from above, that a support has which something carries."""
REACHES = 0.5
"""Share of a support's height that a leg is seen to reach over."""
UNDER = 0.7
"""Share of what carries a support that lies below it."""
SAMPLES = 300


def is_part(body: Body, supports: Supports) -> bool:
    """Whether a body is part of a piece of furniture whose level surfaces are `supports`."""
    points = body.points[:: max(1, len(body.points) // SAMPLES)]
    if body.stand is Stand.ON_SUPPORT:
        return any(
            _runs_along(points, supports.detections[k].box, body.sigma_m)
            for k in np.flatnonzero(supports.large)
            if supports.heights_m[k] == body.support_height_m
        )
    return _carries(points, supports)


def _runs_along(points: NDArray[np.float64], support: OrientedBox, sigma_m: float) -> bool:
    """Whether something thin and upright runs along an edge of what it stands on."""
    cos, sin = math.cos(support.yaw), math.sin(support.yaw)
    x, y = points[:, 0] - support.center_xyz[0], points[:, 1] - support.center_xyz[1]
    spans = [percentiles(x * cos + y * sin, 3.0, 97.0), percentiles(y * cos - x * sin, 3.0, 97.0)]
    for (low, high), (first, last), size, across in (
        (*spans, support.size_xyz[1], support.size_xyz[0]),
        (*spans[::-1], support.size_xyz[0], support.size_xyz[1]),
    ):
        thin = high - low < THIN_M + 2 * sigma_m
        at_edge = across / 2 - max(-low, high) < EDGE_M
        if thin and at_edge and ALONG * size < last - first < 1.5 * size:
            return True
    return False


def _carries(points: NDArray[np.float64], supports: Supports) -> bool:
    """Whether something narrow reaches far up to a support that lies over it.

    The support itself hides from above where they meet.
    """
    low, top = percentiles(points[:, 2], 2.0, 98.0)
    length, width = sides_from_above(points)
    if width > LEG_M:
        return False
    # what is hardly larger than the body is its own top
    larger = supports.areas_m2 >= LARGER * length * max(width, THIN_M)
    for k in np.flatnonzero(larger):
        height = float(supports.heights_m[k])
        if top > height + ABOVE_M or top - low < REACHES * height:
            continue
        ij = ((points[:, :2] - supports.origin_xy) / RASTER_M).astype(int)
        on = ((ij >= 0) & (ij < supports.raster.shape)).all(axis=1)
        bits = supports.raster[ij[on, 0], ij[on, 1]] >> np.uint64(k) & np.uint64(1)
        if bits.sum() >= UNDER * len(points):
            return True
    return False
