"""Writes the graph of a map as GraphML, whole or as the paper draws it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import networkx as nx

from afkb.flow import TopologicalMap
from afkb_graphml.graphs import map_graph, place_graph
from afkb_mapping.grid.map_server import write_grid

GRAPH, PLACES = "map.graphml", "places.graphml"


class GraphMLExporter:
    """The whole graph as GraphML, for networkx, yEd, Gephi."""

    name = "graphml"
    in_map_folder = False

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write map.graphml; `run` is not used."""
        return [_write(map_graph(topological_map), folder / GRAPH)]


class PaperExporter:
    """The paper's output: a graph of robot places with linkage angles, in an occupancy grid.

    What is no robot place fills the grid (paper §II.E, Algorithm 1).
    """

    name = "paper"
    in_map_folder = False

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write places.graphml, and the grid as nav2's map_server reads it; `run` is not used."""
        graph = _write(place_graph(topological_map), folder / PLACES)
        return [graph, *write_grid(topological_map.grid, folder)]


def _write(graph: nx.Graph[str], path: Path) -> Path:
    text = "\n".join(nx.generate_graphml(graph, named_key_ids=True))
    path.write_text(text + "\n", encoding="utf-8")
    return path
