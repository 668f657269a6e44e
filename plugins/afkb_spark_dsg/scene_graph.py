"""A map as a layered scene graph: which node goes where, and what is whose parent."""

from __future__ import annotations

import math
from collections.abc import Iterator

from afkb.flow import EdgeKind, Entity, RobotPlace, TopologicalMap
from afkb_mapping.exporting.describing import NO_ROOM_CATEGORY, likeliest
from afkb_spark_dsg.attributes import (
    BUILDINGS,
    OBJECTS,
    PLACES,
    ROOMS,
    Json,
    building_json,
    edge_json,
    object_json,
    place_json,
    room_json,
    symbol,
)

FORMAT = {"major": 1, "minor": 1, "patch": 3}
"""The version of spark_dsg whose form this is."""
_LAYERS = {"OBJECTS": OBJECTS, "PLACES": PLACES, "ROOMS": ROOMS, "BUILDINGS": BUILDINGS}


def scene_graph(whole: TopologicalMap) -> Json:
    """The map as spark_dsg's JSON.

    A thing's parent is a robot place, the nearest of those that saw it; a place's parent is its
    room, a room's the one building. Edges within a layer: ways between places, passages between
    rooms, and what supports, holds or predicts what. `metadata` of a node holds what spark_dsg has
    no field for: the map's id, kind, beliefs; predicted things say `is_predicted` as well.
    """
    ids = _symbols(whole)
    labels = sorted({likeliest(e.category_belief) for e in whole.entities})
    kinds = sorted({likeliest(r.belief, NO_ROOM_CATEGORY) for r in whole.rooms})
    nodes = [object_json(ids[e.id], e, labels) for e in whole.entities]
    nodes += [place_json(ids[p.id], p) for p in whole.places]
    nodes += [room_json(ids[r.id], r, kinds) for r in whole.rooms]
    nodes.append(building_json(symbol("B", 0), whole.rooms))
    return {
        "SPARK_DSG_header": {"project_name": "main", "version": FORMAT},
        "directed": False,
        "multigraph": False,
        "layer_keys": [{"layer": layer, "partition": 0} for layer in _LAYERS.values()],
        "layer_names": {name: {"layer": i, "partition": 0} for name, i in _LAYERS.items()},
        "metadata": {
            "frame": "map, m and rad, z up",
            "labelspaces": {
                f"_l{OBJECTS}p0": [[i, name] for i, name in enumerate(labels)],
                f"_l{ROOMS}p0": [[i, name] for i, name in enumerate(kinds)],
            },
        },
        "nodes": nodes,
        "edges": _edges(whole, ids),
    }


def _symbols(whole: TopologicalMap) -> dict[str, int]:
    """Ids of the map to spark_dsg's, which are a letter and a number."""
    ids: dict[str, int] = {}
    ids |= {e.id: symbol("O", number) for number, e in enumerate(whole.entities)}
    ids |= {p.id: symbol("p", number) for number, p in enumerate(whole.places)}
    return ids | {r.id: symbol("R", number) for number, r in enumerate(whole.rooms)}


def _edges(whole: TopologicalMap, ids: dict[str, int]) -> list[Json]:
    """All edges, each pair of nodes once: the graph has no parallel ones."""
    found: dict[frozenset[int], Json] = {}
    for source, target, weight, told in _related(whole):
        if source in ids and target in ids and source != target:
            pair = frozenset((ids[source], ids[target]))
            found.setdefault(pair, edge_json(ids[source], ids[target], weight, told))
    building = symbol("B", 0)
    return [*found.values(), *(edge_json(building, ids[r.id], None, {}) for r in whole.rooms)]


def _related(whole: TopologicalMap) -> Iterator[tuple[str, str, float | None, Json]]:
    """Source, target, length (m) where it has one, and what else is known of the edge."""
    for edge in whole.edges:
        if edge.kind is EdgeKind.PATH:
            told = {"bearing": edge.bearing, "linkage_angle": edge.linkage_angle}
            yield edge.source, edge.target, edge.distance, told
    for room in whole.rooms:
        for other in room.connected_to:
            yield room.id, other, None, {"relation": "connected_to"}
    for place in whole.places:
        if place.room is not None:
            yield place.room, place.id, None, {}
    places = {p.id: p for p in whole.places}
    for entity in whole.entities:
        parent = _parent(entity, places)
        if parent is not None:
            yield parent.id, entity.id, None, {}
        for name, holder in (("supported_by", entity.supported_by), ("part_of", entity.part_of)):
            if holder is not None:
                yield entity.id, holder, None, {"relation": name}
        for anchor in entity.predicted_from:
            yield entity.id, anchor, None, {"relation": "predicted_from"}


def _parent(entity: Entity, places: dict[str, RobotPlace]) -> RobotPlace | None:
    """The nearest place that saw or implied it; of one that none did, the nearest of its room."""
    seen = [places[i] for i in entity.seen_from if i in places]
    beside = seen or [p for p in places.values() if p.room == entity.room]
    x, y, _ = entity.position_xyz
    return min(beside, key=lambda p: (math.hypot(p.x - x, p.y - y), p.id), default=None)
