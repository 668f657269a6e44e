"""Whether a thing is a container, how surely, and the `Detection` that says so."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from afkb.flow import Detection
from afkb_containers.settings import ContainerSettings
from afkb_containers.solid import Solid
from afkb_mapping.bodies import Body, Stand
from afkb_mapping.from_above import box_around, on_grid
from afkb_mapping.openings import Opening
from afkb_mapping.order_statistics import percentile
from afkb_mapping.trapezoids import membership

LEAST_CLAIM = 0.1
CUT = 0.5
"""A body that the image edge cuts shows neither its top nor its thickness."""
CLOSED = {Stand.ON_SUPPORT: 0.75, Stand.HIDDEN: 0.60, Stand.ON_FLOOR: 0.0}
"""How often a closed, compact, upright body holds something. On the floor such bodies are stools
and cabinets as often as boxes, so that only an opening counts there."""
SIGHT_SHARE = 0.6
"""Share of what a sight line could show of an opening, from which it is taken for deep."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Probabilities that a thing is an open, and that it is a closed, container."""

    open_p: float
    closed_p: float

    @property
    def contains(self) -> float:
        """Probability that it contains either way."""
        return max(self.open_p, self.closed_p)


def judge(
    body: Body,
    size: float,
    solid: Solid,
    opening: Opening | None,
    settings: ContainerSettings,
) -> Verdict:
    """Weigh an opening against a closed body; `size` is how well the thing's size fits, 0 to 1."""
    open_p = 0.0
    if opening is not None and opening.rim_share >= 0.5:
        deep = membership(opening.depth_m / opening.width_m, settings.depth_over_opening)
        if opening.sight_share >= SIGHT_SHARE:
            deep = max(deep, 0.9)
        if body.stand is Stand.ON_FLOOR:
            deep *= membership(opening.depth_m, settings.bin_depth_m)
        around = min(1.0, (opening.rim_share - 0.5) / 0.3)
        seen = min(1.0, opening.inside_share / 0.15)
        open_p = 0.95 * size * solid.whole * deep * (0.3 + 0.7 * around) * (0.3 + 0.7 * seen)
    closed_p = CLOSED[body.stand] * solid.degree * size * (1 - open_p)
    if body.stand is Stand.HIDDEN:
        closed_p *= membership(solid.length_m, settings.hidden_size_m)
    return Verdict(open_p, closed_p * (CUT if body.cut_by_image else 1.0))


def container_detection(
    body: Body,
    about: int,
    verdict: Verdict,
    solid: Solid,
    opening: Opening | None,
    detector: str,
) -> Detection:
    """The body at index `about`, from its base up to its rim or top; its centre is that box's."""
    base_m = body.base_m
    rim = opening.rim_height_m if opening else base_m + solid.height_m
    box = box_around(on_grid(body.points, 0.005), rim, 0.0, rim - base_m)
    affordances = {"ContainAbility": verdict.contains}
    if verdict.closed_p >= LEAST_CLAIM:
        affordances["IntrinsicContainAbility"] = verdict.closed_p
    spread = body.sigma_m**2 + 1e-4
    return Detection(
        detector=detector,
        affordances=affordances,
        box=box,
        position_xyz=np.array(box.center_xyz),
        covariance_xyz=np.diag([spread, spread, 0.25 * spread]),
        footprint_xy=on_grid(body.points, 0.02),
        n_pixels=len(body.u),
        range_m=percentile(body.depth_m, 1.0),
        image_box=body.image_box,
        cut_by_image=body.cut_by_image,
        measures=_measures(body, rim, solid, opening),
        about=about,
    )


def _measures(body: Body, rim_m: float, solid: Solid, opening: Opening | None) -> dict[str, float]:
    """Heights, and what spoke for and against; no `support_height` where that isn't seen."""
    measures = {
        "rim_height": rim_m,
        "height": rim_m - body.base_m,
        "thickness": solid.thickness_m,
        "solidity": solid.solidity,
    }
    if body.support_height_m is not None:
        measures["support_height"] = body.support_height_m
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
