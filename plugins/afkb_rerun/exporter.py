"""Writes a map as a Rerun recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from afkb.flow import TopologicalMap
from afkb_rerun.drawing import draw
from afkb_rerun.stream import new_stream, save_to

FILE = "map.rrd"


class RerunExporter:
    """A recording for Rerun's viewer, with a slider over time; needs the extra `rerun`."""

    name = "rerun"
    in_map_folder = False
    # Rerun gives each chunk of data a random id.
    same_bytes = False

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write map.rrd; `run` is not used. Raises `PluginError` where Rerun is not installed."""
        path = folder / FILE
        stream = new_stream("map")
        save_to(stream, path)
        draw(stream, topological_map)
        stream.flush()
        stream.disconnect()
        return [path]
