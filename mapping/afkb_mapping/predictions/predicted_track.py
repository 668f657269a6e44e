"""What the mapper remembers between views of things that are expected and unseen."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import NodeKind, PredictionState, Relation
from afkb_mapping.predictions.whereabouts import Whereabouts
from afkb_mapping.things.existence import Existence
from afkb_mapping.things.viewpoints import Viewpoints

Array = NDArray[np.float64]

HEIGHT_TOLERANCE_M = 0.06
"""How far a top may be from where it is expected: noise of both heights."""
FURNITURE_M = 0.35
"""What is longer hides floor that scans and looks would show (the ontology's limit of `Small`)."""


@dataclass(slots=True, eq=False)
class PredictedTrack:
    """One thing that is expected (V_ap or V_ac), where, how high, and how likely it is.

    - `where`: the distribution of its middle; `top_range_m`: the heights its top may have, m.
    - `strength`: what the axiom says of it. `size_xy_m`: its typical extent.
    - `anchors`: id of what it follows from to the existence it had when it last counted.
    - `near_xy`: what it is expected near to, None for what is below or on something; `reach_m`: how
      far from there, or from where it is expected, something may be that fulfils it.
    """

    id: str
    kind: NodeKind
    relation: Relation
    where: Whereabouts
    top_range_m: tuple[float, float]
    strength: float
    affordances: dict[str, float]
    scale: str
    anchors: dict[str, float]
    predictor: str
    axioms: dict[str, None]
    first_seen: float
    last_seen: float
    size_xy_m: tuple[float, float] = (0.0, 0.0)
    categories: dict[str, float] = field(default_factory=dict)
    life: Existence = field(default_factory=Existence)
    decayed: bool = False
    observations: int = 1
    viewpoints: Viewpoints = field(default_factory=Viewpoints)
    missed_from: Viewpoints = field(default_factory=Viewpoints)
    places: dict[str, None] = field(default_factory=dict)
    reach_m: float = 0.0
    near_xy: Array | None = None

    @property
    def probability(self) -> float:
        """That there is such a thing, where it is expected."""
        return self.life.probability

    @property
    def tops_looked_at_m(self) -> tuple[float, float]:
        """Lowest and highest top that a look is asked about, m.

        What carries things has its top at their feet, not above: a flat look over a table sees
        through the air on it.
        """
        low, high = self.top_range_m
        return low, high - HEIGHT_TOLERANCE_M if self.relation is Relation.BELOW else high

    @property
    def is_small(self) -> bool:
        """Whether it hides too little of what is behind it to be seen through."""
        return 0 < max(self.size_xy_m) < FURNITURE_M

    @property
    def state(self) -> PredictionState:
        """How it stands, as long as it is expected."""
        return PredictionState.DECAYED if self.decayed else PredictionState.PREDICTED

    @property
    def center_xy(self) -> Array:
        """Where it most probably is, m: of what is below or on things, the middle."""
        if self.relation is Relation.NEAR:
            return self.where.best_xy()
        return (self.where.low_xy + self.where.high_xy) / 2

    def place(self) -> tuple[Array, Array]:
        """Corners (2,) of where something may be that fulfils it, m."""
        if self.near_xy is not None:
            return self.near_xy - self.reach_m, self.near_xy + self.reach_m
        return self.where.low_xy - self.reach_m / 2, self.where.high_xy + self.reach_m / 2

    def domain(self) -> tuple[Array, Array]:
        """Corners (2,) of all that speaks for or against it: its place, and its distribution."""
        low, high = self.place()
        return np.minimum(low, self.where.low_xy), np.maximum(high, self.where.high_xy)
