"""Which predictions expect the same thing, and which observed thing is what was expected."""

from __future__ import annotations

import numpy as np

from afkb.flow import NodeKind, Relation
from afkb_mapping.predictions.grounding import BELOW_MARGIN_M, HIDDEN_FOOT_M, Walls
from afkb_mapping.predictions.predicted_track import HEIGHT_TOLERANCE_M, PredictedTrack
from afkb_mapping.predictions.whereabouts import Whereabouts
from afkb_mapping.things.tracks import ObservedTrack


def fits(prediction: PredictedTrack, track: ObservedTrack, walls: Walls) -> bool:
    """Whether an observed thing is what was predicted: v_ao ~ v_ap (paper Algorithm 1).

    What is near something has no wall between, and its middle within reach.
    """
    if any(track.affordances.get(name, 0.0) < 0.5 for name in prediction.affordances):
        return False
    if track.id in prediction.anchors or track.is_floor:
        return False
    low, high = prediction.top_range_m
    if not low - HEIGHT_TOLERANCE_M <= track.top.value <= high + HEIGHT_TOLERANCE_M:
        return False
    points = track.footprint.points()
    if prediction.near_xy is not None:
        apart = np.linalg.norm(points - prediction.near_xy, axis=1)
        nearest = int(apart.argmin())
        if apart[nearest] > prediction.reach_m - min(prediction.size_xy_m) / 2:
            return False
        return not walls.part(prediction.near_xy, points[nearest])
    at_least, at_most = prediction.place()
    return bool(((points >= at_least) & (points <= at_most)).all(1).any())


def same_prediction(first: PredictedTrack, second: PredictedTrack) -> bool:
    """Whether two predictions expect the same thing: v_ap ~ v_ap_m (paper Algorithm 1)."""
    if set(first.affordances) != set(second.affordances):
        return False
    if first.kind is not second.kind:
        return _of_two_orders(first, second)
    if first.relation is Relation.NEAR or second.relation is Relation.NEAR:
        shared = first.anchors.keys() & second.anchors.keys()
        apart = float(np.hypot(*(first.center_xy - second.center_xy)))
        return bool(shared) or apart < max(first.reach_m, second.reach_m) / 2
    heights = first.top_range_m[1] - second.top_range_m[1]
    low = np.maximum(first.where.low_xy, second.where.low_xy)
    gap = low - np.minimum(first.where.high_xy, second.where.high_xy)
    return abs(heights) < HIDDEN_FOOT_M / 2 and bool((gap < 2 * BELOW_MARGIN_M).all())


def _of_two_orders(first: PredictedTrack, second: PredictedTrack) -> bool:
    """Whether what co-occurs is what a dual expects: at its height, where it may be."""
    dual, near = (first, second) if first.kind is NodeKind.DUAL else (second, first)
    if near.near_xy is None or dual.relation is not Relation.BELOW:
        return False
    low = max(dual.top_range_m[0], near.top_range_m[0])
    level = low <= min(dual.top_range_m[1], near.top_range_m[1])
    apart = np.linalg.norm(dual.where.points_xy - near.near_xy, axis=1).min()
    return level and bool(apart <= near.reach_m)


def joined(old: PredictedTrack, new: PredictedTrack) -> float:
    """Let a prediction that was made again know the place that both give it.

    Returns the likelihood ratio, at most 1, of what has been seen of that place meanwhile.

    A region under things covers all of them; of a region near things the middle is the mean (paper
    Algorithm 1: c = mean(c, c_k-1)). Of two orders the lower one says where: the levels of
    filtration are of falling importance (§II.D).
    """
    before = old.where.open_share
    if old.kind is NodeKind.DUAL and new.kind is NodeKind.CO_OCCURRENCE:
        pass
    elif old.kind is not new.kind:
        _be_told_by(old, new)
    elif old.near_xy is None or new.near_xy is None:
        low = np.minimum(old.where.low_xy, new.where.low_xy)
        high = np.maximum(old.where.high_xy, new.where.high_xy)
        _move(old, Whereabouts.even(low, high))
    elif old.anchors.keys() & new.anchors.keys():
        shift = (old.near_xy - new.near_xy) / 2
        new.where.points_xy = new.where.points_xy + shift
        _move(old, new.where)
        old.near_xy = new.near_xy + shift
    if old.kind is new.kind:
        low_m = max(min(old.top_range_m[0], new.top_range_m[0]), 0.0)
        old.top_range_m = low_m, min(old.top_range_m[1], new.top_range_m[1])
    old.anchors.update(new.anchors)
    old.axioms.update(new.axioms)
    old.last_seen = new.last_seen
    return min(old.where.open_share / before, 1.0)


def _move(old: PredictedTrack, where: Whereabouts) -> None:
    where.takes_looks_of(old.where)
    old.where = where


def _be_told_by(old: PredictedTrack, new: PredictedTrack) -> None:
    """Become a prediction of the lower order, which knows the place better."""
    _move(old, new.where)
    old.kind, old.relation, old.top_range_m = new.kind, new.relation, new.top_range_m
    old.near_xy, old.reach_m = new.near_xy, new.reach_m
    old.predictor, old.categories = new.predictor, new.categories
