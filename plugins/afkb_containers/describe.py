"""The `Detection` of a body that contains."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox
from afkb_containers.judge import Verdict
from afkb_containers.looks import LEAST_CLAIM, Looks
from afkb_containers.spread import UNKNOWN
from afkb_mapping.bodies import Body
from afkb_mapping.from_above import box_around, on_grid
from afkb_mapping.openings import Opening

LITRES_PER_M3 = 1000.0


def container_detection(
    body: Body, thing: Detection, about: int, verdict: Verdict, looks: Looks, detector: str
) -> Detection:
    """The body of the thing at index `about`, from its base up to its rim or top.

    Its centre is that box's.
    """
    base_m = body.base_m
    rim = looks.opening.rim_height_m if looks.opening else base_m + looks.height_m
    box = box_around(on_grid(body.points, 0.005), rim, 0.0, rim - base_m)
    affordances = {"ContainAbility": verdict.contains}
    if verdict.closed_p >= LEAST_CLAIM:
        affordances["IntrinsicContainAbility"] = verdict.closed_p
    return Detection(
        detector=detector,
        affordances=affordances,
        box=box,
        position_xyz=np.array(box.center_xyz),
        covariance_xyz=_covariance(looks.noise.sigma_m),
        footprint_xy=thing.footprint_xy,
        n_pixels=thing.n_pixels,
        range_m=thing.range_m,
        image_box=thing.image_box,
        cut_by_image=thing.cut_by_image,
        measures=_measures(body, rim, looks) | {"volume": _litres(looks.opening, box)},
        about=about,
    )


def _covariance(noise_m: float) -> NDArray[np.float64]:
    spread = noise_m**2 + 1e-4
    return np.diag([spread, spread, 0.25 * spread])


def _litres(opening: Opening | None, box: OrientedBox) -> float:
    """What it holds at least, as deep as it is seen; of a closed one, the box around it."""
    if opening is not None:
        return LITRES_PER_M3 * opening.width_m**2 * opening.depth_m
    return LITRES_PER_M3 * math.prod(box.size_xyz)


def _measures(body: Body, rim_m: float, looks: Looks) -> dict[str, float]:
    """Heights, and what spoke for and against; no `support_height` where that isn't seen."""
    measures = {
        "rim_height": rim_m,
        "height": rim_m - body.base_m,
        "solidity": looks.outline.solidity if looks.outline else 0.0,
        "noise": looks.noise.sigma_m,
        "roughness": looks.noise.roughness,
    }
    if looks.spread is not UNKNOWN:
        measures["thickness"] = looks.spread.thickness_m
    if body.support_height_m is not None:
        measures["support_height"] = body.support_height_m
    if looks.top is not None:
        measures |= {"lid_share": looks.top.lid_share, "sight": looks.top.sight_m}
    opening = looks.opening
    if opening is not None:
        measures |= {
            "depth": opening.depth_m,
            "opening_width": opening.width_m,
            "rim_share": opening.rim_share,
            "sight_share": opening.sight_share,
            "inside_share": opening.inside_share,
            "n_inside": float(opening.n_inside),
        }
    return measures
