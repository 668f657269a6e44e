"""How many nodes of a map stand for one real surface, when a home is mapped at its true poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import networkx as nx
import numpy as np
import shapely

from afkb.flow import Entity
from bench.detectors.data import Home
from bench.detectors.seen import MARGIN_M

MAPPER, RULE = "affordance", "log-odds"
SHARED = 0.3
"""A node speaks of a top if this part of it, or of the top, lies in the other."""


def support_nodes(home: Home) -> list[Entity]:
    """Nodes that support, of a map of what was seen in the home."""
    mapper = home.host.mapper_factory(MAPPER)(RULE)
    for view, (_, detections) in zip(home.views(), home.seen.views, strict=True):
        mapper.add(view, detections, ())
    found = mapper.finish(np.eye(4)).entities
    return [e for e in found if e.affords("SupportAbility") and e.polygon_xy is not None]


def nodes_per_surface(
    nodes: Sequence[Entity], tops: Sequence[Mapping[str, Any]], tolerance_m: float
) -> float:
    """Nodes that lie on any of the tops, by the surfaces that these are; 0 where none does.

    Tops that one node spans are one surface: a run of base cabinets is one counter.
    """
    graph = nx.Graph()
    for top in tops:
        low, high = np.array(top["min"][:2]) - MARGIN_M, np.array(top["max"][:2]) + MARGIN_M
        box = shapely.box(*low, *high)
        for node in nodes:
            if abs(node.position_xyz[2] - top["top_height"]) > tolerance_m:
                continue
            polygon = shapely.Polygon(node.polygon_xy)
            shared = polygon.intersection(box).area
            if shared > SHARED * min(polygon.area, box.area):
                graph.add_edge(("top", top["name"]), ("node", node.id))
    surfaces = nx.number_connected_components(graph)
    return sum(kind == "node" for kind, _ in graph) / surfaces if surfaces else 0.0
