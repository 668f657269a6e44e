"""The contract of a mapper, and the laws that every map obeys."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from afkb.flow import Detection, Entity, Hypothesis, NodeKind, TopologicalMap, View
from afkb.knowledge import AfNet
from afkb.plugins.protocols import Mapper, MapperFactory
from afkb.testing.require import (
    require,
    require_known,
    require_name,
    require_probability,
    same,
)
from afkb.testing.sample_flow import sample_detections, sample_hypotheses
from afkb.testing.sample_views import sample_views

_RULES = ("log-odds", "noisy-or", "literal")


def check_mapper_factory(
    factory: MapperFactory,
    knowledge_base: AfNet,
    views: Sequence[View] | None = None,
    detections: Sequence[Detection] | None = None,
    hypotheses: Sequence[Hypothesis] | None = None,
) -> None:
    """Raise unless its mappers keep the contract, under every update rule.

    `views`, `detections`, `hypotheses`: what to map, by default a small sample of each.
    A map may be asked for at any time and more views added after; two runs agree to the bit.
    """
    name = require_name(factory, f"mapper factory {type(factory).__name__}")
    views = sample_views() if views is None else views
    if detections is None:
        detections, hypotheses = sample_detections(), sample_hypotheses()
    for rule in _RULES:
        who = f"mapper {name!r} with rule {rule!r}"
        first, again = factory(rule), factory(rule)
        require(isinstance(first, Mapper), who, "makes no Mapper", "see afkb.plugins.protocols")
        require(first is not again, who, "hands out one mapper twice", "make a fresh one each time")
        result = _run(first, views, detections, hypotheses or ())
        check_map(result, knowledge_base, who)
        require(len(result.places) > 0, who, "has no robot place", "keep where the robot stood")
        other = _run(again, views, detections, hypotheses or ())
        require(same(result, other), who, "maps differently the second time", "order its sets")


def _run(
    mapper: Mapper,
    views: Sequence[View],
    detections: Sequence[Detection],
    hypotheses: Sequence[Hypothesis],
) -> TopologicalMap:
    for i, view in enumerate(views):
        mapper.add(view, detections, hypotheses)
        if i == 0:
            mapper.finish(np.eye(4))
    return mapper.finish(np.eye(4))


def check_map(result: TopologicalMap, knowledge_base: AfNet, who: str = "map") -> None:
    """Raise unless ids are unique and resolve, numbers are sane, and words are the ontology's."""
    nodes = [place.id for place in result.places] + [entity.id for entity in result.entities]
    nodes += [bound.id for bound in result.bounds] + [door.id for door in result.doorways]
    nodes += [room.id for room in result.rooms]
    twice = sorted({i for i in nodes if nodes.count(i) > 1})
    require(not twice, who, f"ids {twice} occur twice", "give each node an id of its own")
    ids = set(nodes)
    for entity in result.entities:
        _check_entity(entity, ids, knowledge_base, who)
    for edge in result.edges:
        known = {edge.source, edge.target} <= ids
        require(known, who, f"edge {edge.id} joins unknown nodes", "join ids that are in the map")
        sane = edge.distance >= 0 and math.isfinite(edge.distance) and abs(edge.bearing) <= 3.1416
        require(sane, who, f"edge {edge.id}", "distance in metres, bearing within ±pi")
    _check_rooms(result, knowledge_base, who)
    _check_grid(result, who)


def _check_entity(entity: Entity, ids: set[str], knowledge_base: AfNet, who: str) -> None:
    at = f"{who}, {entity.id}"
    numbers = (*entity.position_xyz, *entity.size_xyz, entity.yaw)
    finite = all(math.isfinite(v) for v in numbers) and min(entity.size_xyz) >= 0
    require(finite, at, f"position, size or yaw {numbers}", "metres and radians, no size negative")
    beliefs: Mapping[str, float] = {**entity.affordances, **entity.category_belief}
    rest = {"existence": entity.existence, "matching_weight": entity.matching_weight}
    for what, p in {**beliefs, **rest}.items():
        require_probability(p, at, what)
    require(len(entity.affordances) > 0, at, "affords nothing", "leave it out")
    require_known(list(entity.affordances), knowledge_base.features, at, "affordances")
    named = [c for c in entity.category_belief if c != "SomethingElse"]
    require_known(named, knowledge_base.categories, at, "categories")
    movable = entity.movability in ("Static", "Dynamic")
    require(movable, at, f"movability {entity.movability!r}", "say Static or Dynamic")
    links = [*entity.seen_from, *entity.predicted_from, entity.supported_by, entity.part_of]
    lost = [i for i in links if i is not None and i not in ids]
    require(not lost, at, f"refers to {lost}", "refer to ids that are in the map")
    if entity.kind in (NodeKind.DUAL, NodeKind.CO_OCCURRENCE):
        require(len(entity.predicted_from) > 0, at, "predicted from nothing", "name its evidence")


def _check_rooms(result: TopologicalMap, knowledge_base: AfNet, who: str) -> None:
    for room in result.rooms:
        at = f"{who}, {room.id}"
        total = sum(room.belief.values())
        whole = math.isclose(total, 1.0, abs_tol=1e-6) and "UnknownRoom" in room.belief
        require(whole, at, f"belief sums to {total:.4f}", "make it 1, UnknownRoom included")
        named = [c for c in room.belief if c != "UnknownRoom"]
        require_known(named, knowledge_base.rooms, at, "rooms")


def _check_grid(result: TopologicalMap, who: str) -> None:
    cells = result.grid.probability
    flat = cells.ndim == 2 and cells.dtype == np.float32 and result.grid.resolution_m > 0
    require(flat, who, f"grid is {cells.shape} {cells.dtype}", "give (rows, cols) float32")
    known = cells[~np.isnan(cells)]
    sane = bool(((known >= 0) & (known <= 1)).all())
    require(sane, who, "grid has cells outside 0..1", "give probabilities, NaN where unknown")
