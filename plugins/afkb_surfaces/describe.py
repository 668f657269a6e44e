"""From a labelled surface to the `Detection` that speaks of it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.from_above import box_around, smallest_rectangle
from afkb_mapping.image_regions import Region
from afkb_mapping.order_statistics import percentiles
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership
from afkb_surfaces.extents import tilt_and_rms
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


def support_detection(
    patch: Region,
    footprint_xy: NDArray[np.float64],
    height_m: float,
    missing_border: float,
    settings: SurfaceSettings,
    detector: str,
) -> Detection | None:
    """What an upward-facing patch affords, or None where it is too small or too steep."""
    area = len(footprint_xy) * settings.footprint_step_m**2
    tilt_deg, rms = tilt_and_rms(patch.points)
    band_px = image_width(patch)
    # a floor or a stage supports however large it is
    p = membership(min(area, settings.area_m2[2]), settings.area_m2) * membership(
        tilt_deg, settings.normal_to_up_deg
    )
    p *= max(membership(band_px, BAND_PX), membership(tilt_deg, LEVEL_DEG))
    p *= max(membership(band_px, SMEAR_PX), SMEARED)
    if p <= 0:
        return None
    box = box_around(footprint_xy, height_m, settings.footprint_step_m)
    nearest, median = percentiles(patch.depth_m, 1.0, 50.0)
    sigma = depth_sigma(median)
    cut = patch.cut_by_image
    spread = 0.25 * math.hypot(*box.size_xyz[:2]) if cut else 0.0
    return Detection(
        detector=detector,
        affordances={"SupportAbility": 0.97 * p},
        box=box,
        position_xyz=np.array([box.center_xyz[0], box.center_xyz[1], height_m]),
        covariance_xyz=np.diag([sigma**2 + spread**2 + 1e-4] * 2 + [(0.4 * sigma) ** 2 + 4e-6]),
        footprint_xy=footprint_xy,
        n_pixels=len(patch.u),
        range_m=nearest,
        image_box=patch.image_box,
        cut_by_image=cut,
        extent_known=missing_border < LOST_BORDER or band_px > STRIP_PX,
        measures={
            "height": height_m,
            "area": area,
            "tilt_deg": tilt_deg,
            "rms": rms,
            "missing_border": missing_border,
            "band_px": band_px,
        },
    )


def image_width(patch: Region) -> float:
    """Mean width of a patch across its longer direction in the image, px."""
    thin = max(1, len(patch.u) // 600)
    _, sides, _ = smallest_rectangle(np.column_stack([patch.u[::thin], patch.v[::thin]]))
    return float(len(patch.u) / (max(sides) + 1.0))
