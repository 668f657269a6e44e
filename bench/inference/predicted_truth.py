"""What a home holds where a map of it predicted something: of a home with its truth."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import ChangeKind, Relation, TopologicalMap
from afkb.knowledge import AfNet
from bench.homes import NO_SUPPORT
from bench.mapping.true_views import T_map_world

Array = NDArray[np.float64]
LEVEL_M = 0.06
"""Tops agree within this: as the mapper has it."""
FOOT_M = 0.20
"""A foot that is hidden lies at most this much lower than it seems, mostly."""
BESIDE_M = 0.10


@dataclass(frozen=True, slots=True)
class Predicted:
    """One prediction of a map: what it said first and last, what came of it, and what is true.

    `first`: probability once its first view had been looked at; `last`: before its end, or where
    the map ends; `seen`: a sight confirmed it.
    """

    home: str
    order: int
    axioms: tuple[str, ...]
    first: float
    last: float
    steps: tuple[float, ...]
    state: str
    true: bool

    @property
    def seen(self) -> bool:
        """Whether it was confirmed."""
        return self.state == "Confirmed"


def predictions_of(
    found: TopologicalMap, truth: Mapping[str, Any], home: str, kb: AfNet
) -> Iterator[Predicted]:
    """Every prediction that a map tells of, past or standing, against the truth."""
    holds = supports_in(truth)
    at = {e.id: np.array(e.position_xyz[:2]) for e in found.entities}
    told = [
        (p.kind, p.axioms, p.history, p.state, p.relation, p.position_xyz, p.predicted_from)
        for p in found.past_predictions
    ] + [
        (e.kind, e.axioms, e.history, e.state, e.region.relation, e.position_xyz, e.predicted_from)
        for e in found.entities
        if e.region is not None
    ]
    for kind, axioms, history, state, relation, xyz, anchors in told:
        assert state is not None
        steps = tuple(c.after for c in history if c.kind is not ChangeKind.CONFIRMED)
        if not steps:
            continue
        names = tuple(a.rsplit("#", 1)[-1] for a in axioms)
        middles = [at[a] for a in anchors if a in at] or [np.array(xyz[:2])]
        tops, reach = _asked(kb, names, relation, float(xyz[2]))
        true = any(holds(middle, tops, reach) for middle in middles)
        first = steps[min(1, len(steps) - 1)]
        order = 1 if kind == "DualPrediction" else 2
        yield Predicted(home, order, names, first, steps[-1], steps, state.value, true)


def _asked(
    kb: AfNet, names: Sequence[str], relation: Relation, top_m: float
) -> tuple[tuple[float, float], float]:
    """Heights of tops, and how far from its anchors a thing may be, m."""
    if relation is not Relation.NEAR:
        return (top_m - FOOT_M, top_m + LEVEL_M), BESIDE_M
    rule = next(r for r in (*kb.co_occurrences, *kb.duals) if r.name in names)
    predicted = getattr(rule, "predicted_class", None)
    tops = kb.evidence_classes[predicted].top_height_m if predicted else (top_m - FOOT_M, top_m)
    mean, sd = rule.distance_m
    return (tops[0] - LEVEL_M, tops[1] + LEVEL_M), mean + 2 * sd - min(rule.size_xy_m) / 2


Holds = Callable[[Array, tuple[float, float], float], bool]


def supports_in(truth: Mapping[str, Any]) -> Holds:
    """Tells whether a support with its top at a height is within reach of a point, map frame."""
    T = T_map_world(truth)
    tops, outlines = [], []
    for thing in truth["things"]:
        if thing["on"] is None and thing["category"] not in NO_SUPPORT and thing["top_height"]:
            (x0, y0), (x1, y1) = thing["min"][:2], thing["max"][:2]
            corners = np.array([[x, y, 0, 1] for x in (x0, x1) for y in (y0, y1)])
            xy = (corners @ T.T)[:, :2]
            tops.append(float(thing["top_height"]))
            outlines.append((xy.min(axis=0), xy.max(axis=0)))

    def holds(middle: Array, heights: tuple[float, float], reach: float) -> bool:
        return any(
            heights[0] <= top <= heights[1]
            and np.linalg.norm(np.maximum(np.maximum(low - middle, middle - high), 0)) <= reach
            for top, (low, high) in zip(tops, outlines, strict=True)
        )

    return holds
