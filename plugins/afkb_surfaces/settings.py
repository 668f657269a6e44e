"""What counts as a surface: physical limits, read from the ontology where it states them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb_mapping.trapezoids import Limits, parameters

if TYPE_CHECKING:
    from afkb.knowledge import AfNet


@dataclass(frozen=True, slots=True)
class SurfaceSettings:
    """Limits of the surface detector; lengths in m, angles in degrees.

    - `normal_to_up_deg`, `area_m2`: of what supports; `bound_height_m`: of what blocks.
    - `floor_m`: heights below this are the floor, carpets and thresholds included.
    - `softness_m`: how far a cushion or blanket strays from a plane within one 12 px window.
    - `step_m`: height step between neighbouring cells that still is one surface.
    - `gap_m`: parts of one surface that something in front keeps this far apart are one.
    - `borders`: settle borders to the pixel; without, they are those of cells, which then are
      twice as coarse, in half the time. Small supports far off are missed so.
    """

    normal_to_up_deg: Limits = (-1.0, 0.0, 15.0, 30.0)
    area_m2: Limits = (0.015, 0.06, math.inf, math.inf)
    bound_height_m: Limits = (0.6, 1.0, math.inf, math.inf)
    floor_m: float = 0.05
    softness_m: float = 0.004
    step_m: float = 0.010
    gap_m: float = 0.35
    bound_area_m2: float = 0.10
    footprint_step_m: float = 0.02
    borders: bool = True

    @classmethod
    def from_knowledge(cls, knowledge_base: AfNet) -> SurfaceSettings:
        """The limits that the features state in the ontology; what they leave out stays."""
        support = parameters(knowledge_base, "SupportAbility")
        block = parameters(knowledge_base, "BlockAbility")
        base = cls()
        return cls(
            normal_to_up_deg=support.get("normal_to_up_deg", base.normal_to_up_deg),
            area_m2=support.get("area_m2", base.area_m2),
            bound_height_m=block.get("height_m", base.bound_height_m),
        )
