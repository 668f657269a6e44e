"""The contract of a predictor."""

from __future__ import annotations

import math
from collections.abc import Sequence

from afkb.flow import Detection, Hypothesis
from afkb.knowledge import AfNet
from afkb.plugins.protocols import Predictor
from afkb.testing.require import (
    require,
    require_known,
    require_name,
    require_probability,
    same,
)


def check_predictor(
    predictor: Predictor, detections: Sequence[Detection], knowledge_base: AfNet
) -> None:
    """Raise unless the predictor keeps its contract on one view's detections.

    Symbolic, deterministic, anchored in what it was handed, and in the ontology's words.
    """
    name = require_name(predictor, f"predictor {type(predictor).__name__}")
    who = f"predictor {name!r}"
    require(isinstance(predictor, Predictor), who, "is no Predictor", "see afkb.plugins.protocols")
    require(predictor.order in (1, 2), who, f"order {predictor.order!r}", "1 dual, 2 co-occurrence")
    nothing = list(predictor.predict(()))
    require(not nothing, who, "predicts from nothing", "return () where nothing was detected")
    found = list(predictor.predict(tuple(detections)))
    again = list(predictor.predict(tuple(detections)))
    require(same(found, again), who, "predicts differently the second time", "keep no state")
    for hypothesis in found:
        _check_hypothesis(hypothesis, predictor, len(detections), who)
        _check_words(hypothesis, knowledge_base, who)


def _check_hypothesis(h: Hypothesis, predictor: Predictor, n_detections: int, who: str) -> None:
    require(isinstance(h, Hypothesis), who, f"returns {type(h).__name__}", "return Hypotheses")
    require(h.predictor == predictor.name, who, f"signs as {h.predictor!r}", "sign with its name")
    require(h.order == predictor.order, who, f"order {h.order}", f"its own is {predictor.order}")
    in_range = all(0 <= a < n_detections for a in h.anchors)
    require(in_range, who, f"anchors {h.anchors}", f"index the {n_detections} detections it got")
    lengths = (*h.distance_m, *h.size_xy_m, *(h.top_height_m or ()))
    sane = all(math.isfinite(v) and v >= 0 for v in lengths)
    require(sane, who, f"distances, sizes or heights {lengths}", "give metres, none negative")
    require(
        "://" in h.axiom, who, f"axiom is {h.axiom!r}", "give the IRI of the statement behind it"
    )
    for what, p in {**h.affordances, **(h.categories or {})}.items():
        require_probability(p, who, what)


def _check_words(h: Hypothesis, knowledge_base: AfNet, who: str) -> None:
    require_known(list(h.affordances), knowledge_base.features, who, "affordances")
    require_known(list(h.categories or ()), knowledge_base.categories, who, "categories")
    require_known([h.scale], knowledge_base.scales, who, "scale")
