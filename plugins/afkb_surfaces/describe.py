"""From a measured patch to the `Detection` that speaks of it."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.from_above import box_around
from afkb_mapping.image_regions import Rectangle
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership
from afkb_surfaces.extents import row_ends
from afkb_surfaces.patches import HEIGHT, MEDIAN, NEAREST, RMS, TILT
from afkb_surfaces.settings import SurfaceSettings

BAND_PX = (6.0, 16.0, math.inf, math.inf)
LEVEL_DEG = (-1.0, 0.0, 5.0, 10.0)
"""A band narrower than BAND_PX is a surface only if it is level: where a thing stands before a
wall, the sensor draws a ramp from its upper edge to the wall."""
SMEAR_PX, SMEARED = (4.0, 9.0, math.inf, math.inf), 0.4
"""The sensor smears an edge over about four pixels: a level band that narrow is doubtful still."""
LOST_BORDER, STRIP_PX = 0.3, 30.0
"""A strip in the image that for this part of its border ends where the sensor returns nothing, as
glossy and black tops do, may reach anywhere; of a broad patch at least what was seen is known."""
KINECT_FOCAL_PX = 550.0
"""Focal length at which all pixels here are counted: a finer image shows a smear in more pixels."""


def support_probability(
    area_m2: float, tilt_deg: float, band_px: float, settings: SurfaceSettings
) -> float:
    """How surely an upward-facing patch supports; 0 where it is too small, steep or narrow.

    `band_px`: mean width in the image across its longer direction, at KINECT_FOCAL_PX.
    """
    # a floor or a stage supports however large it is
    p = membership(min(area_m2, settings.area_m2[2]), settings.area_m2)
    p *= membership(tilt_deg, settings.normal_to_up_deg)
    p *= max(membership(band_px, BAND_PX), membership(tilt_deg, LEVEL_DEG))
    return 0.97 * p * max(membership(band_px, SMEAR_PX), SMEARED)


def support_detection(
    p: float,
    m: list[float],
    height_m: float,
    footprint_xy: NDArray[np.float64],
    border: Mapping[str, float],
    measures: Mapping[str, float],
    image_box: Rectangle,
    pixels: NDArray[np.int32] | None,
    rings_xy: tuple[NDArray[np.float64], ...],
    cut: bool,
    noise: float,
    step_m: float,
    detector: str,
) -> Detection:
    """The detection of a patch with these measures (see `patches`), its top at height_m."""
    box = box_around(row_ends(footprint_xy), height_m, step_m)
    sigma = noise * depth_sigma(m[MEDIAN])
    covariance = np.zeros((3, 3))
    spread = 0.25 * math.hypot(*box.size_xyz[:2]) if cut else 0.0
    covariance[0, 0] = covariance[1, 1] = sigma**2 + spread**2 + 1e-4
    covariance[2, 2] = (0.4 * sigma) ** 2 + 4e-6
    missing = border.get("missing", 0.0)
    tilt_deg = math.degrees(m[TILT])
    return Detection(
        detector=detector,
        affordances={"SupportAbility": p},
        box=box,
        position_xyz=np.array([box.center_xyz[0], box.center_xyz[1], height_m]),
        covariance_xyz=covariance,
        footprint_xy=footprint_xy,
        n_pixels=int(measures["pixels"]),
        range_m=m[NEAREST],
        image_box=image_box,
        cut_by_image=cut,
        extent_known=missing < LOST_BORDER or measures["band_px"] > STRIP_PX,
        measures={
            "height": m[HEIGHT],
            "tilt_deg": tilt_deg,
            "rms": m[RMS],
            "missing_border": missing,
            **{name: value for name, value in measures.items() if name != "pixels"},
        },
        pixels=pixels,
        rings_xy=rings_xy,
        border=border,
    )
