"""The occupancy grid as nav2's map_server loads it; see `afkb_mapping.grid.map_server`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from afkb.flow import TopologicalMap
from afkb_mapping.grid.map_server import write_grid


class Nav2Exporter:
    """The occupancy grid for nav2's map_server, PGM and YAML; in every map folder.

    Writes occupancy.pgm and occupancy.yaml.
    """

    name = "nav2"
    in_map_folder = True

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write the grid into the folder; `run` is not used."""
        return write_grid(topological_map.grid, folder)
