"""The `Detection` of a body."""

from __future__ import annotations

import numpy as np

from afkb.flow import Detection
from afkb_mapping.bodies import Body
from afkb_mapping.from_above import box_around, on_grid, sides_from_above
from afkb_mapping.order_statistics import percentile
from afkb_things.primitives import box_of, primitive_of
from afkb_things.settings import ThingSettings
from afkb_things.wholeness import wholeness

SAMPLES = 3000
"""About so many points say how large a body is; its footprint is of all."""
HIGHEST_M = ThingSettings().above_m[1]
LEAST_WHOLE = 0.2
"""What is hardly ever a whole body has no shape to be fitted."""


def body_detection(body: Body, attached: float, detector: str) -> Detection:
    """A body from its base up to its top; `attached` is the share of its outline that goes on."""
    points = np.ascontiguousarray(body.points[:: max(1, len(body.points) // SAMPLES)])
    sides = sides_from_above(points)
    base, top = body.base_m, percentile(points[:, 2], 98.0)
    box = box_around(on_grid(points, 0.005), top, 0.0, max(top - base, 0.0))
    whole = wholeness(body, top - base, HIGHEST_M, sides[0], attached)
    shape = primitive_of(body, box) if whole >= LEAST_WHOLE else None
    if shape is not None:
        box = box_of(shape)
    spread = body.sigma_m**2 + 1e-4
    return Detection(
        detector=detector,
        affordances={"DisposeAbility": whole},
        box=box,
        position_xyz=np.array(box.center_xyz),
        covariance_xyz=np.diag([spread, spread, 0.25 * spread]),
        footprint_xy=on_grid(body.points, 0.02),
        n_pixels=len(body.u),
        range_m=percentile(body.depth_m[:: max(1, len(body.u) // SAMPLES)], 1.0),
        image_box=body.image_box,
        cut_by_image=body.cut_by_image,
        measures=_measures(body, base, top, *sides, attached),
        primitive=shape,
        pixels=(body.v * np.int32(body.shape[1]) + body.u).astype(np.int32),
    )


def _measures(
    body: Body, base_m: float, top_m: float, length: float, width: float, attached: float
) -> dict[str, float]:
    """Heights, sides and surroundings; no `support_height` where that isn't seen."""
    measures = {
        "stand": float(body.stand),
        "bottom": base_m,
        "height": top_m - base_m,
        "length": length,
        "width": width,
        "attached": attached,
    }
    if body.support_height_m is not None:
        measures["support_height"] = body.support_height_m
    if any(body.slope):
        measures |= dict(zip(("slope_x", "slope_y", "slope_offset"), body.slope, strict=True))
    return measures
