"""What counts as a container: physical limits of things, of openings and of solids."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb_mapping.bodies import Stand
from afkb_mapping.trapezoids import Limits, parameters

if TYPE_CHECKING:
    from afkb.knowledge import AfNet


@dataclass(frozen=True, slots=True)
class ContainerSettings:
    """Limits of the container detector, m; trapezoids as (z1, n1, n2, z2).

    - `size_m`: longer side, seen from above, of a thing that stands on a support.
    - `depth_over_opening`: of an opening, unless a sight line could show no more of it, and
      `max_extent_m`, of a closed body: both as the ontology states them.
    - `solid_height_m`, `solid_thickness_m`: of a closed body, which keep books, frames, screens
      and game controllers out; `upright_height_m`: of one that is about as high as long.
    - `closed_size_m`: longer side of a closed body, and `hidden_size_m` of one whose support isn't
      seen; what is larger is furniture as often.
    - `bin_size_m`: `size_m` of what stands on the floor; `bin_depth_m`: depth of its opening.
    - `basin_width_m`: shorter side of what is let into a support; `basin_depth_m`: depth that is
      enough however wide it is.
    - `tallest_m`: highest point of a thing over its support that is looked at.
    """

    size_m: Limits = (0.035, 0.05, 0.35, 0.60)
    depth_over_opening: Limits = (0.10, 0.25, 10.0, 20.0)
    max_extent_m: Limits = (0.02, 0.05, 0.6, 1.0)
    closed_size_m: Limits = (-math.inf, 0.0, 0.30, 0.40)
    hidden_size_m: Limits = (-math.inf, 0.0, 0.20, 0.35)
    bin_size_m: Limits = (0.12, 0.18, 0.65, 0.85)
    bin_depth_m: Limits = (0.05, 0.10, math.inf, math.inf)
    basin_width_m: Limits = (0.10, 0.20, math.inf, math.inf)
    basin_depth_m: Limits = (0.08, 0.15, math.inf, math.inf)
    solid_height_m: Limits = (0.060, 0.075, 0.35, 0.50)
    upright_height_m: Limits = (0.050, 0.062, 0.35, 0.50)
    solid_thickness_m: Limits = (0.012, 0.020, math.inf, math.inf)
    tallest_m: float = 0.50

    def sides_m(self, stand: Stand) -> Limits:
        """Limits of the longer side of a thing, by what it stands on."""
        return self.bin_size_m if stand is Stand.ON_FLOOR else self.size_m

    def closed_sides_m(self, stand: Stand) -> Limits:
        """The same of a closed body."""
        return self.hidden_size_m if stand is Stand.HIDDEN else self.closed_size_m

    @classmethod
    def from_knowledge(cls, knowledge_base: AfNet) -> ContainerSettings:
        """The limits that the features state in the ontology; what they leave out stays."""
        opening = parameters(knowledge_base, "ContainAbility")
        solid = parameters(knowledge_base, "IntrinsicContainAbility")
        base = cls()
        return cls(
            depth_over_opening=opening.get("depth_over_opening", base.depth_over_opening),
            max_extent_m=solid.get("max_extent_m", base.max_extent_m),
        )
