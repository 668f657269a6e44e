"""The life of a prediction: where it may be, what spoke for and against it, what came of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from afkb.flow.evidence import Change
from afkb.flow.hypothesis import Relation


class PredictionState(StrEnum):
    """How a prediction stands; values are the OWL individuals.

    It is predicted, and decays as looks and time speak against it; then it ends: confirmed by a
    direct observation (the paper's loop closing), refuted by looks, or expired, as what it follows
    from is gone or too long ago.
    """

    PREDICTED = "Predicted"
    DECAYED = "Decayed"
    CONFIRMED = "Confirmed"
    REFUTED = "Refuted"
    EXPIRED = "Expired"


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """Where a predicted thing is if it is there at all: a distribution over places, map frame.

    - `relation`: below, on or near its anchors.
    - `parts`: (N, 3) x, y (m) of the middle of a square and the share of the probability that the
      thing's middle is in it; shares sum to 1, the greatest first.
    - `part_m`: side of the squares, m. `tops_m`: lowest and highest height of its top, m.
    """

    relation: Relation
    parts: NDArray[np.float64]
    part_m: float
    tops_m: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class PastPrediction:
    """A prediction that came to its end: what it was, and what came of it.

    `kind`: value of the `NodeKind` it was; `probability`: before the last event; `seen_as`: id of
    the observed thing that confirmed it; `predicted_from`: ids of things still in the map.
    """

    id: str
    kind: str
    state: PredictionState
    position_xyz: tuple[float, float, float]
    affordances: Mapping[str, float]
    probability: float
    relation: Relation
    first_seen: float
    ended: float
    history: tuple[Change, ...]
    generated_by: str
    predicted_from: tuple[str, ...] = ()
    axioms: tuple[str, ...] = ()
    seen_as: str | None = None
