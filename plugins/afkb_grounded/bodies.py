"""Measures of bodies: extents, roundness, taper, tops, stability."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, Primitive, View
from afkb_grounded.body_kernel import (
    SLICES,
    circle_fit,
    foot_share,
    missing_within,
    principal,
    slice_widths,
    sphere_fit,
    top_from_above,
)
from afkb_grounded.texture import texture_measures
from afkb_mapping.depth_points import points_of_pixels
from afkb_mapping.order_statistics import percentile, percentiles
from afkb_mapping.sensor_noise import depth_sigma

MOST_POINTS = 1500
"""A shape is clear from so many points; more take only time."""
LEAST_POINTS = 30
SQUARE_CIRCULARITY = math.pi / 4
"""Circularity of a square: its area over that of the circle round its sides' distance."""
ARC_SEEN = 0.9
"""Share of its diameter that a round body shows across, seen from one side."""
DEPTH_SEEN = 0.3
"""Least extent over greatest of the arc, of 140° or more, that a round body shows to one side."""
TOP_WITHIN_M = 0.01
"""How far a level top may stray from its height, beside the sensor's noise."""
FLAT_TOP_SHARE = 0.3
"""Share of a body, seen from above, from which it has a flat top."""
FOOTPRINT_CELL_M2 = 0.02**2


def body_measures(body: Detection, view: View) -> dict[str, float]:
    """Every measure that the body's box, primitive and pixels tell; see measures.csv."""
    extents = _extents(body)
    found = _box_measures(body, extents)
    if body.pixels is None or view.depth_m is None or len(body.pixels) < LEAST_POINTS:
        return found
    found["missing_depth_share"] = missing_within(body.pixels, view.depth_m)
    found |= texture_measures(body.pixels, view.color)
    thin = max(1, len(body.pixels) // MOST_POINTS)
    pixels, width = body.pixels[::thin], np.int32(view.depth_m.shape[1])
    depths, points = points_of_pixels(pixels % width, pixels // width, view)
    points, depths = points[depths > 0], depths[depths > 0]
    if len(points) < LEAST_POINTS:
        return found
    return found | _shape_measures(points, percentile(depths, 50.0), extents, body.primitive)


def _extents(body: Detection) -> tuple[float, float, float]:
    """Extents along the body's own axes, m, falling."""
    size = body.primitive.size_xyz if body.primitive is not None else body.box.size_xyz
    longest, middle, shortest = sorted((max(float(s), 1e-3) for s in size), reverse=True)
    return longest, middle, shortest


def _box_measures(body: Detection, extents: tuple[float, float, float]) -> dict[str, float]:
    width, length = sorted(max(s, 1e-3) for s in body.box.size_xyz[:2])
    height = max(body.box.size_xyz[2], 1e-3)
    longest, middle, shortest = extents
    found = {
        "length_m": length,
        "width_m": width,
        "height_m": height,
        "top_height_m": body.box.top,
        "bottom_height_m": max(body.box.bottom, 0.0),
        "max_extent_m": longest,
        "middle_extent_m": middle,
        "min_extent_m": shortest,
        "area_m2": len(body.footprint_xy) * FOOTPRINT_CELL_M2,
        "volume_m3": longest * middle * shortest,
        "height_over_base": height / width,
        "elongation": longest / middle,
        "aspect": longest / middle,
        "thickness_over_extent": shortest / longest,
    }
    support = body.measures.get("support_height")
    if support is not None:
        found["to_support_m"] = max(body.box.bottom - support, 0.0)
    return found


def _shape_measures(
    points: NDArray[np.float64],
    depth: float,
    extents: tuple[float, float, float],
    primitive: Primitive | None,
) -> dict[str, float]:
    sigma = depth_sigma(depth)
    variances, axes = principal(points)
    tilt = math.degrees(math.acos(min(abs(float(axes[2, 2])), 1.0)))
    lies = tilt > 45 and extents[0] > 1.3 * extents[1]
    longest = extents[0]
    found = {
        "axis_to_up_deg": tilt,
        "planarity_rms_over_extent": _without_noise(math.sqrt(variances[0]), sigma) / longest,
        "sphere_fit_rms_over_radius": _sphere_residual(points, sigma, longest),
        "cross_section_circularity": (
            _circularity(points, axes, lies, sigma)
            if primitive is None
            else _primitive_circularity(primitive, sigma)
        ),
    }
    return found | _profile_measures(points, axes) | _level_measures(points, sigma)


def _without_noise(rms: float, sigma: float) -> float:
    """What of an rms distance the sensor's noise doesn't explain."""
    return math.sqrt(max(rms**2 - sigma**2, 0.0))


def _sphere_residual(points: NDArray[np.float64], sigma: float, longest: float) -> float:
    """Residual over radius; a sphere's diameter is also its extent, which a plane's isn't."""
    radius, rms = sphere_fit(points)
    if not 0 < radius < math.inf:
        return 1.0
    other_size = max(abs(longest / (2 * radius) - 1.0) - (1.0 - ARC_SEEN) - sigma / radius, 0.0)
    return min(_without_noise(rms, sigma) / radius + other_size, 1.0)


def _circularity(
    points: NDArray[np.float64], axes: NDArray[np.float64], lies: bool, sigma: float
) -> float:
    """Of the cross-section in the middle, across the long axis of what lies, else level."""
    if lies:
        plane, along = points @ axes[:2].T, points @ axes[2]
    else:
        plane, along = points[:, :2], points[:, 2]
    along = np.ascontiguousarray(along)
    radius, rms, across, narrow = circle_fit(
        np.ascontiguousarray(plane), *percentiles(along, 20.0, 80.0), along
    )
    if not 0 < radius < math.inf:
        return SQUARE_CIRCULARITY
    flat = max(ARC_SEEN - across / (2 * radius), DEPTH_SEEN - narrow / across, 0.0)
    return max(1.0 - _without_noise(rms, sigma) / radius - flat, 0.0)


def _primitive_circularity(primitive: Primitive, sigma: float) -> float:
    """By the second exponent of the superquadric that it is: 0 a square, 1 a circle."""
    round_ = min(max(primitive.exponents[1], 0.0), 1.0)
    left = _without_noise(primitive.residual_m, sigma) / max(max(primitive.size_xyz) / 2, 1e-3)
    return max(SQUARE_CIRCULARITY + (1.0 - SQUARE_CIRCULARITY) * round_ - left, 0.0)


def _profile_measures(points: NDArray[np.float64], axes: NDArray[np.float64]) -> dict[str, float]:
    """How the width changes along the longest axis: tips, and heads on handles."""
    along = np.ascontiguousarray(points @ axes[2])
    widths = slice_widths(along, np.ascontiguousarray(points @ axes[1]))
    if (widths > 0).sum() < SLICES - 1:
        return {}
    middle = percentile(widths[SLICES // 3 : -(SLICES // 3)], 50.0)
    tip = min(widths[0] + widths[1], widths[-2] + widths[-1]) / 2
    head = max(float(widths[:4].max()), float(widths[-4:].max()))
    handle = percentile(np.sort(widths)[: SLICES // 2], 50.0)
    return {
        "tip_over_middle": float(tip) / max(middle, 1e-3),
        "head_over_handle": head / max(handle, 1e-3),
    }


def _level_measures(points: NDArray[np.float64], sigma: float) -> dict[str, float]:
    """Flat top, and foot: what it stands by, and what may stand on it."""
    within = TOP_WITHIN_M + sigma
    share, slope, _ = top_from_above(points, max(0.01, 2 * sigma), within)
    foot = percentile(np.ascontiguousarray(points[:, 2]), 25.0)
    found = {"flat_top_share": share, "base_share": foot_share(points, foot)}
    if share >= FLAT_TOP_SHARE:
        found["top_bottom_angle_deg"] = math.degrees(math.atan(slope))
    return found
