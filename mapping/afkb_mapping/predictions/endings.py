"""Predictions that came to their end, and how often each end came."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass

from afkb.flow import PastPrediction, PredictionState
from afkb_mapping.predictions.predicted_track import PredictedTrack


@dataclass(frozen=True, slots=True, eq=False)
class Ended:
    """A prediction that ended at a stamp, s, its probability before, and what was seen instead."""

    prediction: PredictedTrack
    state: PredictionState
    stamp: float
    probability: float
    seen_as: str | None = None


def ends_counted(ended: Iterable[Ended]) -> dict[str, int]:
    """How many predictions were confirmed, refuted and expired."""
    states = [e.state for e in ended]
    told = (PredictionState.CONFIRMED, PredictionState.REFUTED, PredictionState.EXPIRED)
    return {state.value.lower(): states.count(state) for state in told}


def past_predictions(
    ended: Iterable[Ended], known: Collection[str], id_now: Callable[[str], str]
) -> tuple[PastPrediction, ...]:
    """The ended predictions as the map tells of them, by their order.

    `known`: ids of the things in the map; `id_now`: of a thing that has become part of another.
    """
    return tuple(_told(e, known, id_now) for e in ended)


def _told(end: Ended, known: Collection[str], id_now: Callable[[str], str]) -> PastPrediction:
    prediction = end.prediction
    x, y = (float(v) for v in prediction.center_xy)
    anchors = dict.fromkeys(id_now(a) for a in prediction.anchors)
    seen_as = id_now(end.seen_as) if end.seen_as else None
    return PastPrediction(
        id=prediction.id,
        kind=prediction.kind.value,
        state=end.state,
        position_xyz=(x, y, sum(prediction.top_range_m) / 2),
        affordances=prediction.affordances,
        probability=end.probability,
        relation=prediction.relation,
        first_seen=prediction.first_seen,
        ended=end.stamp,
        history=tuple(prediction.life.history),
        generated_by=prediction.predictor,
        predicted_from=tuple(a for a in anchors if a in known),
        axioms=tuple(prediction.axioms),
        seen_as=seen_as if seen_as in known else None,
    )
