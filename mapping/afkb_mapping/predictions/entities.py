"""Predictions as the map states them (V_ap, V_ac): entities with a region and a history."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Entity, NodeKind, Region, Relation
from afkb.inference import Network
from afkb_mapping.predictions.predicted_track import HEIGHT_TOLERANCE_M, PredictedTrack
from afkb_mapping.things.entities import SURFACE_THICKNESS_M
from afkb_mapping.things.standing import FOOT_HIDDEN_M, STANDS_WITHIN_M
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.visits.persistence import hazard_of

FAINTEST_SHARE = 0.005
"""Parts of a region that are less probable are not worth stating."""
LEAST_EXTENT_M = 0.2

Array = NDArray[np.float64]


def predicted_entities(
    predictions: Iterable[PredictedTrack],
    network: Network,
    known: Collection[str],
    id_now: Callable[[str], str],
) -> list[Entity]:
    """Entities of predictions whose anchors are still in the map, as what they are now."""
    entities = []
    for track in predictions:
        now = dict.fromkeys(id_now(a) for a in track.anchors)
        anchors = tuple(a for a in now if a in known)
        if anchors:
            entities.append(_predicted(track, anchors, network))
    return entities


def supports_expected(
    predictions: Iterable[PredictedTrack], tracks: Iterable[ObservedTrack]
) -> dict[str, str]:
    """Thing to the unseen support that it follows from and may stand on: id to id."""
    bottoms = {t.id: t.bottom.value for t in tracks}
    return {
        anchor: track.id
        for track in predictions
        if track.kind is NodeKind.DUAL and "SupportAbility" in track.affordances
        for anchor in track.anchors
        if track.top_range_m[0] - STANDS_WITHIN_M
        <= bottoms.get(anchor, -1.0)
        <= track.top_range_m[1] + FOOT_HIDDEN_M
    }


def _predicted(track: PredictedTrack, anchors: tuple[str, ...], network: Network) -> Entity:
    x, y = (float(v) for v in track.center_xy)
    half = _extent(track) / 2
    width, depth = (float(v) for v in 2 * half)
    belief = _belief(track, network)
    movability, weight = network.movability(belief)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return Entity(
        id=track.id,
        kind=track.kind,
        position_xyz=(x, y, _top(track)),
        size_xyz=(width, depth, SURFACE_THICKNESS_M),
        yaw=0.0,
        affordances=track.affordances,
        existence=track.probability,
        category_belief=belief,
        movability=movability,
        matching_weight=weight,
        observations=track.observations,
        first_seen=track.first_seen,
        last_seen=track.last_seen,
        seen_from=tuple(track.places),
        generated_by=(track.predictor,),
        predicted_from=anchors,
        axioms=tuple(track.axioms),
        extent_known=False,
        polygon_xy=track.center_xy + corners * half,
        region=region_of(track),
        state=track.state,
        history=tuple(track.life.history),
    )


def _extent(track: PredictedTrack) -> Array:
    """(2,) m: its typical extent, or of what is below or on things the region's."""
    extent: Array = np.subtract(track.where.high_xy, track.where.low_xy)
    if track.relation is Relation.NEAR:
        extent = np.maximum(np.asarray(track.size_xy_m, np.float64), LEAST_EXTENT_M)
    return extent


def hazard_of_prediction(track: PredictedTrack, network: Network) -> float:
    """Rate, 1/s, at which such things are moved: by the movability of what it may be."""
    return hazard_of(network.movability(_belief(track, network))[1])


def _top(track: PredictedTrack) -> float:
    """Where its top is expected, m: of what carries things at their feet, else in the middle."""
    low, high = track.top_range_m
    return high - HEIGHT_TOLERANCE_M if track.relation is Relation.BELOW else (low + high) / 2


def _belief(track: PredictedTrack, network: Network) -> dict[str, float]:
    """What it may be: as its predictor says, or by what it affords, its extent and its height.

    How far something below its anchors reaches is unobserved.
    """
    known = network.knowledge_base.categories
    told = {name: p for name, p in track.categories.items() if name in known}
    if told:
        return told
    width, depth = (float(v) for v in _extent(track))
    size = (width, depth, 0.0) if track.relation is Relation.NEAR else (0.0, 0.0, 0.0)
    return network.category_posterior(network.known(track.affordances), size, _top(track))


def region_of(track: PredictedTrack) -> Region:
    """Its distribution over places, the likeliest first."""
    shares = track.where.shares
    order = [i for i in np.argsort(-shares, kind="stable") if shares[i] >= FAINTEST_SHARE]
    order = order or [int(np.argmax(shares))]
    kept = shares[order] / shares[order].sum()
    parts = np.column_stack([track.where.points_xy[order], kept])
    return Region(track.relation, parts, track.where.step_m, track.top_range_m)
