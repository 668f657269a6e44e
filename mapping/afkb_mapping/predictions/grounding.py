"""Gives hypotheses a place: a symbolic "below these cups" becomes a region of the map frame."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Hypothesis, NodeKind, Relation, View
from afkb_mapping.predictions.predicted_track import PredictedTrack
from afkb_mapping.things.tracks import ObservedTrack

BELOW_MARGIN_M = 0.10
"""A support reaches at least this far beyond what stands on it."""
HIDDEN_FOOT_M = 0.35
"""Where the support itself is hidden, so may be a thing's foot: this much of it at most."""
HEIGHT_TOLERANCE_M = 0.06
DIRECTIONS = 8
KIND_OF_ORDER = {1: NodeKind.DUAL, 2: NodeKind.CO_OCCURRENCE}

WALL_STEP_M = 0.05


class KnownCells(Protocol):
    """What the grid so far tells about points (N, 2) of the map frame: (N,) each."""

    def unknown(self, points_xy: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether nothing has been seen there."""
        ...

    def occupied(self, points_xy: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether something stands there."""
        ...


class Walls(Protocol):
    """What the bounds so far tell."""

    def part(self, start_xy: NDArray[np.float64], end_xy: NDArray[np.float64]) -> bool:
        """Whether a wall stands between two points (2,)."""
        ...


def ground(
    hypothesis: Hypothesis,
    anchors: Sequence[ObservedTrack],
    foot_hidden: bool,
    view: View,
    cells: KnownCells,
    walls: Walls,
) -> PredictedTrack | None:
    """The region of a hypothesis, or None where everything about it has been looked at.

    What is below or on its anchors lies under their common outline; what is near them lies at its
    typical distance, on a side that has not been seen yet and that no wall parts from them. It has
    no id before it is kept.
    """
    region = (
        _near(hypothesis, anchors, cells, walls)
        if hypothesis.relation is Relation.NEAR
        else _under(anchors)
    )
    if region is None:
        return None
    return PredictedTrack(
        id="",
        kind=KIND_OF_ORDER[hypothesis.order],
        low_xy=region[0],
        high_xy=region[1],
        top_range_m=_top_range(hypothesis, anchors, foot_hidden),
        probability=hypothesis.probability,
        affordances=dict(hypothesis.affordances),
        scale=hypothesis.scale,
        anchors=dict.fromkeys(a.id for a in anchors),
        predictor=hypothesis.predictor,
        axioms={hypothesis.axiom: None},
        first_seen=view.stamp,
        last_seen=view.stamp,
        categories=dict(hypothesis.categories or {}),
        reach_m=hypothesis.distance_m[0] + 2 * hypothesis.distance_m[1],
        near_xy=_middle(anchors) if hypothesis.relation is Relation.NEAR else None,
    )


Region = tuple[NDArray[np.float64], NDArray[np.float64]]


def _middle(anchors: Sequence[ObservedTrack]) -> NDArray[np.float64]:
    middle: NDArray[np.float64] = np.concatenate([a.footprint.points() for a in anchors]).mean(0)
    return middle


def _under(anchors: Sequence[ObservedTrack]) -> Region:
    points = np.concatenate([a.footprint.points() for a in anchors])
    return points.min(axis=0) - BELOW_MARGIN_M, points.max(axis=0) + BELOW_MARGIN_M


def _near(
    hypothesis: Hypothesis, anchors: Sequence[ObservedTrack], cells: KnownCells, walls: Walls
) -> Region | None:
    anchor_points = np.concatenate([a.footprint.points() for a in anchors])
    anchor = _middle(anchors)
    reach = float(np.linalg.norm(anchor_points - anchor, axis=1).max())
    half = np.maximum(np.asarray(hypothesis.size_xy_m), 0.2) / 2
    offsets = np.stack(np.meshgrid(*[np.linspace(-h, h, 5) for h in half]), axis=-1).reshape(-1, 2)
    way = np.arange(reach, hypothesis.distance_m[0] + half.max(), WALL_STEP_M)[:, None]
    best: tuple[float, NDArray[np.float64]] = (0.5, anchor)
    for angle in np.arange(DIRECTIONS) * 2 * np.pi / DIRECTIONS:
        heading = np.array([np.cos(angle), np.sin(angle)])
        center = anchor + hypothesis.distance_m[0] * heading
        unseen = float(cells.unknown(center + offsets).mean())
        if unseen <= best[0] or cells.occupied(anchor + way * heading).any():
            continue
        if not walls.part(anchor, center):
            best = unseen, center
    if best[0] <= 0.5:
        return None
    return best[1] - half, best[1] + half


def _top_range(
    hypothesis: Hypothesis, anchors: Sequence[ObservedTrack], foot_hidden: bool
) -> tuple[float, float]:
    if hypothesis.top_height_m is not None and hypothesis.relation is Relation.NEAR:
        return hypothesis.top_height_m
    if hypothesis.relation is Relation.ON:
        top = max(a.top.value for a in anchors)
        return top, top + HIDDEN_FOOT_M
    bottom = min(a.bottom.value for a in anchors)
    hidden = HIDDEN_FOOT_M if foot_hidden else HEIGHT_TOLERANCE_M
    return max(bottom - hidden, HEIGHT_TOLERANCE_M), bottom + HEIGHT_TOLERANCE_M


def fits(prediction: PredictedTrack, track: ObservedTrack) -> bool:
    """Whether an observed thing is what was predicted: v_ao ~ v_ap (paper Algorithm 1)."""
    if any(track.affordances.get(name, 0.0) < 0.5 for name in prediction.affordances):
        return False
    if track.id in prediction.anchors or track.is_floor:
        return False
    low, high = prediction.top_range_m
    if not low - HEIGHT_TOLERANCE_M <= track.top.value <= high + HEIGHT_TOLERANCE_M:
        return False
    return _touches(prediction, track)


def _touches(prediction: PredictedTrack, track: ObservedTrack) -> bool:
    points = track.footprint.points()
    slack = prediction.reach_m / 2
    inside = ((points >= prediction.low_xy - slack) & (points <= prediction.high_xy + slack)).all(1)
    return bool(inside.any())


def same_prediction(first: PredictedTrack, second: PredictedTrack) -> bool:
    """Whether two predictions expect the same thing: v_ap ~ v_ap_m (paper Algorithm 1)."""
    if first.kind != second.kind or set(first.affordances) != set(second.affordances):
        return False
    if first.kind is NodeKind.CO_OCCURRENCE:
        shared = first.anchors.keys() & second.anchors.keys()
        apart = float(np.hypot(*(first.center_xy - second.center_xy)))
        return bool(shared) or apart < max(first.reach_m, second.reach_m) / 2
    heights = first.top_range_m[1] - second.top_range_m[1]
    gap = np.maximum(first.low_xy, second.low_xy) - np.minimum(first.high_xy, second.high_xy)
    return abs(heights) < HIDDEN_FOOT_M / 2 and bool((gap < 2 * BELOW_MARGIN_M).all())


def joined(old: PredictedTrack, new: PredictedTrack) -> None:
    """Average the centres of two predictions of one thing (Algorithm 1: c = mean(c, c_k-1)).

    A region under things covers all of them; a region near things keeps its size.
    """
    center = (old.center_xy + new.center_xy) / 2
    if old.kind is NodeKind.DUAL:
        old.low_xy = np.minimum(old.low_xy, new.low_xy)
        old.high_xy = np.maximum(old.high_xy, new.high_xy)
    else:
        half = old.size_xy / 2
        old.low_xy, old.high_xy = center - half, center + half
    old.top_range_m = (
        max(min(old.top_range_m[0], new.top_range_m[0]), 0.0),
        min(old.top_range_m[1], new.top_range_m[1]),
    )
    old.anchors.update(new.anchors)
    old.axioms.update(new.axioms)
    old.last_seen = new.last_seen
