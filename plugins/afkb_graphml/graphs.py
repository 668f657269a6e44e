"""A map as networkx graphs: G(V, E) of the paper, and its graph of places."""

from __future__ import annotations

import networkx as nx

from afkb.flow import Bound, Edge, EdgeKind, Entity, RobotPlace, TopologicalMap
from afkb_mapping.exporting.describing import (
    Flat,
    flat_bound,
    flat_doorway,
    flat_entity,
    flat_place,
    flat_room,
)


def map_graph(whole: TopologicalMap) -> nx.MultiDiGraph[str]:
    """All nodes by id, and all that relates them; attributes are in m, rad and s.

    Edges have a `relation`: `path`, `obstacle` or `bound` with the distance and bearing from source
    to target, and between things and rooms `supported_by`, `part_of`, `in_room`, `predicted_from`,
    `seen_from`, `connects` (a doorway its rooms) and `connected_to` (rooms).
    """
    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph(frame="map, m and rad, z up")
    for place in whole.places:
        graph.add_node(place.id, **flat_place(place))
    for entity in whole.entities:
        graph.add_node(entity.id, **flat_entity(entity))
    for bound in whole.bounds:
        graph.add_node(bound.id, **flat_bound(bound))
    for doorway in whole.doorways:
        graph.add_node(doorway.id, **flat_doorway(doorway))
    for room in whole.rooms:
        graph.add_node(room.id, **flat_room(room))
    for edge in whole.edges:
        graph.add_edge(edge.source, edge.target, edge.id, **_measured(edge))
    for source, relation, target in _relations(whole):
        if target in graph:
            graph.add_edge(source, target, f"{source}_{relation}_{target}", relation=relation)
    return graph


def place_graph(whole: TopologicalMap) -> nx.Graph[str]:
    """The robot's places and the ways between them, each with its linkage angle (paper §II.E)."""
    graph: nx.Graph[str] = nx.Graph(frame="map, m and rad, z up")
    for place in whole.places:
        graph.add_node(place.id, **flat_place(place))
    for edge in whole.edges:
        if edge.kind is EdgeKind.PATH:
            graph.add_edge(edge.source, edge.target, **{"from": edge.source}, **_measured(edge))
    return graph


def _measured(edge: Edge) -> Flat:
    told: Flat = {
        "id": edge.id,
        "relation": edge.kind.value,
        "distance": edge.distance,
        "bearing": edge.bearing,
    }
    if edge.linkage_angle is not None:
        told["linkage_angle"] = edge.linkage_angle
    return told


def _relations(whole: TopologicalMap) -> list[tuple[str, str, str]]:
    """What relates nodes besides measured edges: (source, relation, target)."""
    found: list[tuple[str, str, str]] = []
    nodes: tuple[RobotPlace | Entity | Bound, ...] = (
        *whole.places,
        *whole.entities,
        *whole.bounds,
    )
    found += [(node.id, "in_room", node.room) for node in nodes if node.room]
    for entity in whole.entities:
        one = {"supported_by": entity.supported_by, "part_of": entity.part_of}
        found += [(entity.id, name, other) for name, other in one.items() if other]
        found += [(entity.id, "predicted_from", other) for other in entity.predicted_from]
        found += [(entity.id, "seen_from", place) for place in entity.seen_from]
    for doorway in whole.doorways:
        found += [(doorway.id, "connects", room) for room in doorway.rooms]
    for room in whole.rooms:
        found += [(room.id, "connected_to", other) for other in room.connected_to]
    return found
