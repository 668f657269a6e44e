"""What counts as a container: physical limits of things, of openings and of solids."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb_surfaces.settings import Limits, parameters

if TYPE_CHECKING:
    from afkb.knowledge import KnowledgeBase


@dataclass(frozen=True, slots=True)
class ContainerSettings:
    """Limits of the container detector, m; trapezoids as (z1, n1, n2, z2).

    - `size_m`: longer side, seen from above, of a thing that stands on a support.
    - `depth_m`: how deep an opening is; `solid_height_m`, `solid_thickness_m`: of a closed body,
      which keep books, frames, screens and game controllers out.
    - `core_m`: what rises less over its support, a magazine or a cloth, joins nothing.
    - `bin_size_m`, `bin_depth_m`: the same as `size_m` and `depth_m` for what stands on the floor.
    - `above_m`: lowest and highest point of a thing over its support that is looked at.
    """

    size_m: Limits = (0.035, 0.05, 0.35, 0.60)
    depth_m: Limits = (0.008, 0.025, math.inf, math.inf)
    bin_size_m: Limits = (0.12, 0.18, 0.65, 0.85)
    bin_depth_m: Limits = (0.05, 0.10, math.inf, math.inf)
    solid_height_m: Limits = (0.060, 0.075, 0.35, 0.50)
    solid_thickness_m: Limits = (0.018, 0.030, math.inf, math.inf)
    core_m: float = 0.032
    above_m: tuple[float, float] = (0.012, 0.50)
    min_pixels: int = 90
    cell_m: float = 0.01

    @classmethod
    def from_knowledge(cls, knowledge_base: KnowledgeBase) -> ContainerSettings:
        """The limits that the features state in the ontology; what they leave out stays."""
        opening = parameters(knowledge_base, "ContainAbility")
        solid = parameters(knowledge_base, "IntrinsicContainAbility")
        base = cls()
        return cls(
            depth_m=opening.get("opening_depth_m", base.depth_m),
            solid_height_m=solid.get("solid_height_m", base.solid_height_m),
            solid_thickness_m=solid.get("solid_thickness_m", base.solid_thickness_m),
        )
