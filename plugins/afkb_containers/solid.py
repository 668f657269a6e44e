"""Intrinsic contain-ability: a closed, compact, convex body (paper §II.F: cans, cartons, boxes)."""

from __future__ import annotations

from afkb_containers.settings import ContainerSettings
from afkb_containers.silhouette import Silhouette
from afkb_containers.spread import Spread
from afkb_mapping.trapezoids import membership, ramp

SOLIDITY = (0.70, 0.85)
"""Share of its core's convex hull that a body must fill: not at all below, fully above."""
CORE_SHARE = (0.60, 0.80)
"""Share of a body that must be its core: plants, and lamps on stems, are mostly twigs and stem."""
STEM = (0.15, 0.30)
"""How far a body may reach below its core, as a share of its height: a lamp stands on a stem."""
WHOLE = (0.50, 0.70)
"""Solidity of a hollow body, which may be seen through its handle: rails and chairs fall below."""
NARROW_M = (0.025, 0.040)
"""Width of a closed body: below the first are pens, tubes and slats."""
SLENDER = (5.0, 8.0)
"""Height over width: posts and rods are above."""
PLATE = (0.12, 0.20)
"""Thickness over width, as far as seen: books, frames and screens are below; the front of a bottle
bows more, and a carton shows a side or its top."""
UNSEEN_THICKNESS = 0.80
"""How often a body that stands free is no plate, where noise hides how thick it is."""
DEEP = (0.40, 0.60)
LEAN_DEG = (4.0, 8.0)
"""Cartons and cans stand upright; what leans further, and isn't this deep for its width, is a
frame, a book or a screen. Levelling is off by one or two degrees."""
FACE = (0.70, 0.85)
"""Share of a body in one plane: from the second on one sees a face and nothing else, so that
whatever else seems to make it deep is strays of what is behind."""
SQUAT = (0.55, 0.80)
"""Height over length: what is this upright is a cup or a can even if it is low."""


def sized(height_m: float, length_m: float, settings: ContainerSettings) -> float:
    """How much a thing is as high as a can or carton, 0 to 1; its length is from above."""
    tall = membership(max(height_m, length_m), settings.max_extent_m)
    return tall * _tall(height_m, length_m, settings)


def compact(height_m: float, spread: Spread, settings: ContainerSettings) -> float:
    """How much a thing is as thick and upright as a can or carton, 0 to 1."""
    slender = ramp(height_m / max(spread.width_m, 1e-3), SLENDER)
    wide = ramp(spread.width_m, NARROW_M) * (1 - slender)
    return _thick(spread, height_m, settings) * wide * (1 - _leans(spread))


def _leans(spread: Spread) -> float:
    """How much a body is a plate that leans, 0 to 1: by the face one sees, else by the whole."""
    if spread.lies:
        return 0.0
    flat = ramp(spread.face_share, FACE)
    as_whole = ramp(spread.lean_deg, LEAN_DEG) * (1 - ramp(spread.shape, DEEP))
    return flat * ramp(spread.face_lean_deg, LEAN_DEG) + (1 - flat) * as_whole


def convex(outline: Silhouette, height_m: float) -> float:
    """How much an outline is that of a closed body, 0 to 1."""
    return ramp(outline.solidity, SOLIDITY) * _in_one(outline, height_m)


def whole(outline: Silhouette, height_m: float) -> float:
    """How much an outline is that of one body, which may be hollow, 0 to 1."""
    return ramp(outline.solidity, WHOLE) * _in_one(outline, height_m)


def _in_one(outline: Silhouette, height_m: float) -> float:
    stem = ramp(outline.stem_m / height_m, STEM)
    return ramp(outline.core_share, CORE_SHARE) * (1 - stem)


def _tall(height_m: float, length_m: float, settings: ContainerSettings) -> float:
    """Tall enough to hold something; lower where it is upright, as cups are and controllers not."""
    upright = ramp(height_m / max(length_m, 1e-3), SQUAT)
    return max(
        membership(height_m, settings.solid_height_m),
        upright * membership(height_m, settings.upright_height_m),
    )


def _thick(spread: Spread, height_m: float, settings: ContainerSettings) -> float:
    """Mean over what the thickness may be; where noise could make as much, how often such are.

    Of what is looked down on, one sees a lid; it is as thick as it is high over its support.
    """
    width = max(spread.width_m, 1e-3)
    may_be = (spread.least_m, spread.thickness_m, spread.most_m)
    degrees = (membership(t, settings.solid_thickness_m) * ramp(t / width, PLATE) for t in may_be)
    unseen = membership(spread.doubt_m, settings.solid_thickness_m)
    unseen *= ramp(max(spread.doubt_m, spread.most_m) / width, PLATE)
    thick = max(UNSEEN_THICKNESS * unseen, sum(degrees) / len(may_be))
    return max(thick, membership(height_m, settings.solid_height_m)) if spread.lies else thick
