"""Measures of openings, surfaces, uprights and gaps, from what their detectors measured."""

from __future__ import annotations

import math

import numpy as np

from afkb.flow import Detection
from afkb_grounded.seen import Seen
from afkb_mapping.sensor_noise import depth_sigma

FOOTPRINT_CELL_M2 = 0.02**2


def opening_measures(thing: Seen) -> dict[str, float]:
    """Depth of a hollow and width of its opening."""
    depth = thing.measures["depth"]
    width = max(thing.measures.get("opening_width", min(thing.first.box.size_xyz[:2])), 1e-3)
    return {"depth_m": depth, "opening_width_m": width, "depth_over_opening": depth / width}


def surface_measures(surface: Detection) -> dict[str, float]:
    """Extents, height, tilt and flatness of what supports."""
    width, length = sorted(max(s, 1e-3) for s in surface.box.size_xyz[:2])
    area = surface.measures.get("area", len(surface.footprint_xy) * FOOTPRINT_CELL_M2)
    height = float(surface.position_xyz[2])
    found = {
        "length_m": length,
        "width_m": width,
        "height_m": height,
        "top_height_m": height,
        "max_extent_m": length,
        "area_m2": area,
        "aspect": length / width,
    }
    if "tilt_deg" in surface.measures:
        found["normal_to_up_deg"] = surface.measures["tilt_deg"]
    if "rms" in surface.measures:
        sigma = depth_sigma(surface.range_m)
        left = math.sqrt(max(surface.measures["rms"] ** 2 - sigma**2, 0.0))
        found["planarity_rms_over_extent"] = left / length
    return found


def upright_measures(upright: Detection) -> dict[str, float]:
    """Length along the wall, height, area of an upright plane."""
    assert upright.segment_xy is not None
    length = max(float(np.linalg.norm(upright.segment_xy[1] - upright.segment_xy[0])), 1e-3)
    height = max(upright.box.size_xyz[2], 1e-3)
    return {
        "length_m": length,
        "height_m": height,
        "top_height_m": upright.box.top,
        "bottom_height_m": max(upright.box.bottom, 0.0),
        "max_extent_m": max(length, height),
        "area_m2": length * height,
        "aspect": max(length, height) / min(length, height),
        "normal_to_up_deg": upright.measures.get("tilt_deg", 90.0),
    }


def gap_measures(gap: Detection) -> dict[str, float]:
    """Clear width and height of a passage."""
    measures = gap.measures
    return {
        "width_m": measures.get("width", max(gap.box.size_xyz[:2])),
        "height_m": gap.box.size_xyz[2],
        "top_height_m": gap.box.top,
        "bottom_height_m": max(gap.box.bottom, 0.0),
    }
