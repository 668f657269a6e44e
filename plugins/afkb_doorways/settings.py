"""How wide and how high a passage is: from the ontology."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from afkb_mapping.trapezoids import Limits, parameters

if TYPE_CHECKING:
    from afkb.knowledge import AfNet


@dataclass(frozen=True, slots=True)
class DoorwaySettings:
    """Trapezoids (z1, n1, n2, z2) of pass-ability, m; the defaults are the ontology's."""

    width_m: Limits = (0.55, 0.7, 1.8, 2.5)
    height_m: Limits = (1.7, 1.9, 2.4, 3.5)

    @classmethod
    def of(cls, knowledge_base: AfNet) -> DoorwaySettings:
        """As the ontology at hand states them."""
        stated = parameters(knowledge_base, "PassAbility")
        return cls(**{f.name: stated[f.name] for f in fields(cls) if f.name in stated})
