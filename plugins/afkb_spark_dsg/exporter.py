"""Writes the JSON that spark_dsg saves, without needing that package."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from afkb.flow import TopologicalMap
from afkb_spark_dsg.scene_graph import scene_graph

FILE = "scene.dsg.json"


class SparkDsgExporter:
    """A 3D scene graph for spark_dsg and Hydra's tools: objects, places, rooms, a building."""

    name = "spark-dsg"
    in_map_folder = False

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write scene.dsg.json; `run` is not used."""
        path = folder / FILE
        text = json.dumps(scene_graph(topological_map), separators=(",", ":"), allow_nan=False)
        path.write_text(text + "\n", encoding="utf-8")
        return [path]
