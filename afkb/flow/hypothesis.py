"""What follows from detections without having been seen: symbolic, grounded later by mapping."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum


class Relation(StrEnum):
    """Where the predicted thing is, relative to its anchors."""

    BELOW = "below"
    ON = "on"
    NEAR = "near"


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """A thing that is expected, though unseen (paper §II.D.ii duals, §II.D.iii co-occurrences).

    - `order`: 1 for an affordance dual, 2 for a co-occurrence.
    - `anchors`: indexes, into the view's detections, of what it follows from.
    - `affordances`: feature name to probability, of the predicted thing.
    - `categories`: object category to probability; None leaves it to what a map states of it.
    - `scale`: scale class of the predicted thing (`Small`, `Medium`, `Large`).
    - `distance_m`: mean and standard deviation of the horizontal distance from the anchors, m.
    - `size_xy_m`: typical extent of the predicted thing, m.
    - `top_height_m`: lowest and highest height of its upper surface above the floor, m, or None
      where the relation fixes it (what is below a cup ends where the cup begins).
    - `axiom`: IRI of the statement in the ontology behind it.
    """

    predictor: str
    order: int
    relation: Relation
    anchors: tuple[int, ...]
    affordances: Mapping[str, float]
    scale: str
    probability: float
    axiom: str
    distance_m: tuple[float, float] = (0.0, 0.0)
    size_xy_m: tuple[float, float] = (0.0, 0.0)
    top_height_m: tuple[float, float] | None = None
    categories: Mapping[str, float] | None = None

    def __post_init__(self) -> None:
        if self.order not in (1, 2):
            raise ValueError(f"{self.predictor}: order {self.order}, expected 1 or 2")
        if not self.anchors:
            raise ValueError(f"{self.predictor}: a hypothesis follows from something")
        if not (math.isfinite(self.probability) and 0 <= self.probability <= 1):
            raise ValueError(f"{self.predictor}: probability {self.probability} is not in 0..1")
