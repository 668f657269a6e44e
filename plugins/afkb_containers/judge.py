"""Whether a thing is a container, and how surely."""

from __future__ import annotations

from dataclasses import dataclass

from afkb_containers.looks import RIM_SHARE, Looks
from afkb_containers.settings import ContainerSettings
from afkb_containers.solid import convex, whole
from afkb_mapping.bodies import Body, Stand
from afkb_mapping.openings import Top
from afkb_mapping.trapezoids import membership, ramp

CUT = 0.5
"""A body that the image edge cuts shows neither its top nor its thickness."""
CLOSED_UNSEEN = 0.9
"""How often a container is closed if nothing is seen of its top."""
LID = (0.4, 0.8)
"""Share of sight lines that end on its top: all of an open thing go in, all of a closed one end."""
SHALLOW = (0.15, 0.35)
"""Share of what sight lines could show of a hollow, up to which it is the dent of a lid."""
DENT = (0.05, 0.10)
"""Depth seen over the height of a thing: less is a dent in the top of something tall."""
INSIDE_SHARE = 0.15
DEEP_SIGMAS = 2.5
"""What seems less deep than so many times the noise is the lowest that noise puts on a flat top."""
SIGHT_SHARE = 0.6
"""Share of what a sight line could show of an opening, from which it is taken for deep."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Probabilities that a thing is an open, that it is a closed, and that it is a container."""

    open_p: float
    closed_p: float
    contains: float


def judge(
    body: Body, size: float, free: float, cut: bool, looks: Looks, settings: ContainerSettings
) -> Verdict:
    """Weigh an opening against a closed body.

    `size`: how well the thing's size fits; `free`: how freely it stands, for a closed one; 0 to 1;
    `cut`: whether the image edge cuts it.
    """
    if looks.outline is None:
        return Verdict(0.0, 0.0, 0.0)
    whole_p = whole(looks.outline, looks.height_m)
    open_p = 0.95 * size * whole_p * _open(body.stand, looks, settings)
    solid_p = (1 - open_p) * looks.compact * size * convex(looks.outline, looks.height_m)
    solid_p *= free * looks.detached * looks.clear * (CUT if cut else 1.0)
    if looks.top is None or not looks.top.tells:
        return Verdict(open_p, solid_p * CLOSED_UNSEEN, open_p + solid_p)
    closed_p = solid_p * _lidded(looks.top)
    return Verdict(open_p, closed_p, open_p + closed_p)


def _lidded(top: Top) -> float:
    """How much a top in sight is a lid: sight lines end on it, or a little below its rim."""
    lid = ramp(top.lid_share, LID)
    return lid if top.opening is None else max(lid, 1 - ramp(top.opening.sight_share, SHALLOW))


def _open(stand: Stand, looks: Looks, settings: ContainerSettings) -> float:
    """How much an opening is one that holds something."""
    opening = looks.opening
    if opening is None or opening.rim_share < RIM_SHARE[0]:
        return 0.0
    if opening.depth_m < DEEP_SIGMAS * looks.noise.sigma_m:
        return 0.0
    deep = membership(opening.depth_m / opening.width_m, settings.depth_over_opening)
    if opening.sight_share >= SIGHT_SHARE:
        deep = max(deep, 0.9)
    if stand is Stand.ON_FLOOR:
        deep *= membership(opening.depth_m, settings.bin_depth_m)
    deep *= ramp(opening.depth_m / looks.height_m, DENT)
    around = ramp(opening.rim_share, RIM_SHARE)
    seen = min(1.0, opening.inside_share / INSIDE_SHARE)
    return deep * (0.2 + 0.8 * around) * (0.5 + 0.5 * seen)
