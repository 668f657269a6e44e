"""Gives hypotheses a place: a symbolic "below these cups" becomes a region of the map frame."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Hypothesis, NodeKind, Relation, View
from afkb_mapping.predictions.predicted_track import (
    FURNITURE_M,
    HEIGHT_TOLERANCE_M,
    PredictedTrack,
)
from afkb_mapping.predictions.whereabouts import Whereabouts
from afkb_mapping.things.tracks import ObservedTrack

BELOW_MARGIN_M = 0.10
"""A support reaches at least this far beyond what stands on it."""
HIDDEN_FOOT_M = 0.35
"""Where the support itself is hidden, so may be a thing's foot: this much of it at most."""
KIND_OF_ORDER = {1: NodeKind.DUAL, 2: NodeKind.CO_OCCURRENCE}

WALL_STEP_M = 0.05

Array = NDArray[np.float64]


class KnownCells(Protocol):
    """What the grid so far tells about points (N, 2) of the map frame: (N,) each."""

    def unknown(self, points_xy: Array) -> NDArray[np.bool_]:
        """Whether nothing has been seen there."""
        ...

    def occupied(self, points_xy: Array) -> NDArray[np.bool_]:
        """Whether something stands there."""
        ...


class Walls(Protocol):
    """What the bounds so far tell."""

    def part(self, start_xy: Array, end_xy: Array) -> bool:
        """Whether a wall stands between two points (2,)."""
        ...

    def part_from(self, start_xy: Array, ends_xy: Array) -> NDArray[np.bool_]:
        """(N,) whether a wall stands between a point (2,) and points (N, 2)."""
        ...


def ground(
    hypothesis: Hypothesis,
    anchors: Sequence[ObservedTrack],
    foot_hidden: bool,
    view: View,
    cells: KnownCells,
    walls: Walls,
) -> PredictedTrack | None:
    """A hypothesis with its region, or None where everything about it has been looked at.

    What is below or on its anchors lies under their common outline; what is near them lies at its
    typical distance, where no wall parts it from them and, if it is furniture, where nothing has
    been seen yet. It has no id before it is kept.
    """
    is_near = hypothesis.relation is Relation.NEAR
    where = _near(hypothesis, anchors, cells, walls) if is_near else _under(anchors)
    if where is None:
        return None
    spread = hypothesis.distance_m[0] + 2 * hypothesis.distance_m[1]
    return PredictedTrack(
        id="",
        kind=KIND_OF_ORDER[hypothesis.order],
        relation=hypothesis.relation,
        where=where,
        top_range_m=_top_range(hypothesis, anchors, foot_hidden),
        strength=hypothesis.probability,
        affordances=dict(hypothesis.affordances),
        scale=hypothesis.scale,
        anchors={a.id: a.existence for a in anchors},
        predictor=hypothesis.predictor,
        axioms={hypothesis.axiom: None},
        first_seen=view.stamp,
        last_seen=view.stamp,
        size_xy_m=hypothesis.size_xy_m,
        categories=dict(hypothesis.categories or {}),
        reach_m=spread + (_reach(anchors) if is_near else 0.0),
        near_xy=_middle(anchors) if is_near else None,
    )


def _points(anchors: Sequence[ObservedTrack]) -> Array:
    return np.concatenate([a.footprint.points() for a in anchors])


def _middle(anchors: Sequence[ObservedTrack]) -> Array:
    middle: Array = _points(anchors).mean(0)
    return middle


def _reach(anchors: Sequence[ObservedTrack]) -> float:
    return float(np.linalg.norm(_points(anchors) - _middle(anchors), axis=1).max())


def _under(anchors: Sequence[ObservedTrack]) -> Whereabouts:
    points = _points(anchors)
    return Whereabouts.even(
        points.min(axis=0) - BELOW_MARGIN_M, points.max(axis=0) + BELOW_MARGIN_M
    )


def _near(
    hypothesis: Hypothesis, anchors: Sequence[ObservedTrack], cells: KnownCells, walls: Walls
) -> Whereabouts | None:
    """The ring about the anchors, without what is behind walls or has been seen."""
    anchor = _middle(anchors)
    where = Whereabouts.around(anchor, hypothesis.distance_m)
    if max(hypothesis.size_xy_m) >= FURNITURE_M:
        where.unseen = _unseen(where.points_xy, hypothesis.size_xy_m, cells)
        where.density *= ~_something_between(anchor, _reach(anchors), where.points_xy, cells)
    where.density *= ~walls.part_from(anchor, where.points_xy)
    return where if where.open_share > 0 else None


def _unseen(points_xy: Array, size_xy_m: tuple[float, float], cells: KnownCells) -> Array:
    """(N,) share of a thing's outline about each point that nobody has seen."""
    half = np.maximum(np.asarray(size_xy_m), 0.2) / 2
    offsets = np.stack(np.meshgrid(*[np.linspace(-h, h, 5) for h in half]), axis=-1).reshape(-1, 2)
    samples = (points_xy[:, None] + offsets).reshape(-1, 2)
    share: Array = cells.unknown(samples).reshape(len(points_xy), -1).mean(axis=1)
    return share


def _something_between(
    anchor: Array, reach_m: float, points_xy: Array, cells: KnownCells
) -> NDArray[np.bool_]:
    """(N,) whether something stands on the way from the anchor's border to each point."""
    steps = np.arange(reach_m, float(np.linalg.norm(points_xy - anchor, axis=1).max()), WALL_STEP_M)
    to = points_xy - anchor
    length = np.maximum(np.linalg.norm(to, axis=1), 1e-6)
    way = anchor + steps[None, :, None] * (to / length[:, None])[:, None]
    stands = cells.occupied(way.reshape(-1, 2)).reshape(len(points_xy), -1)
    between: NDArray[np.bool_] = (stands & (steps[None] < length[:, None])).any(axis=1)
    return between


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
