"""What the mapper remembers between views of things that are expected and unseen."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import NodeKind
from afkb_mapping.things.viewpoints import Viewpoints


@dataclass(slots=True, eq=False)
class PredictedTrack:
    """One thing that is expected (V_ap or V_ac), where, how high, and how likely it is.

    It covers an upright rectangle `low_xy`..`high_xy` of the floor plane; `top_range_m` are the
    heights its top may have, m. `near_xy`: what it is expected near to, None for what is below.
    """

    id: str
    kind: NodeKind
    low_xy: NDArray[np.float64]
    high_xy: NDArray[np.float64]
    top_range_m: tuple[float, float]
    probability: float
    affordances: dict[str, float]
    scale: str
    anchors: dict[str, None]
    predictor: str
    axioms: dict[str, None]
    first_seen: float
    last_seen: float
    categories: dict[str, float] = field(default_factory=dict)
    observations: int = 1
    viewpoints: Viewpoints = field(default_factory=Viewpoints)
    empty_from: Viewpoints = field(default_factory=Viewpoints)
    places: dict[str, None] = field(default_factory=dict)
    reach_m: float = 0.0
    near_xy: NDArray[np.float64] | None = None

    @property
    def center_xy(self) -> NDArray[np.float64]:
        """Middle of the rectangle, m."""
        return (self.low_xy + self.high_xy) / 2

    @property
    def size_xy(self) -> NDArray[np.float64]:
        """Extent of the rectangle, m."""
        return self.high_xy - self.low_xy

    def place(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Corners (2,) of where something may be that fulfils it, m: half its reach around it."""
        return self.low_xy - self.reach_m / 2, self.high_xy + self.reach_m / 2

    def domain(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Corners (2,) of all that speaks for or against it: its place, and what it is near to."""
        low, high = self.place()
        near = self.center_xy if self.near_xy is None else self.near_xy
        return np.minimum(low, near), np.maximum(high, near)

    def sample_points(self, step_m: float = 0.1) -> NDArray[np.float64]:
        """(N, 2) points of its expected upper surface, map frame."""
        axes = [
            np.linspace(lo, hi, max(2, round((hi - lo) / step_m)))
            for lo, hi in zip(self.low_xy, self.high_xy, strict=True)
        ]
        x, y = np.meshgrid(*axes)
        return np.column_stack([x.ravel(), y.ravel()])
