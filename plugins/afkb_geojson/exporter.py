"""Writes a map as GeoJSON: in the map's own metres, or at its true place on Earth."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict

from afkb.errors import PluginError
from afkb.flow import TopologicalMap
from afkb.plugins.options import read_options
from afkb_geojson.anchor import Anchor, anchor_of
from afkb_geojson.features import features

FILE = "map.geojson"
_MAP_FRAME = (
    'ENGCRS["map frame of a robot",EDATUM["the robot\'s first pose"],CS[Cartesian,2],'
    'AXIS["x",unspecified],AXIS["y",unspecified],LENGTHUNIT["metre",1]]'
)
"""The map frame as well-known text. RFC 7946 has dropped `crs`, and says nothing of places that are
not known on Earth; GDAL and QGIS read it, others see plain numbers."""


class _Options(BaseModel):
    model_config = ConfigDict(extra="forbid", arbitrary_types_allowed=True)

    anchor: Annotated[Anchor | None, BeforeValidator(anchor_of)] = None


@dataclass(frozen=True, slots=True)
class GeoJsonExporter:
    """GeoJSON for QGIS, shapely and GDAL: rooms, things, places, walls, doorways and ways.

    Coordinates are metres of the map frame, and the file says so by a local reference system; with
    an anchor they are longitude and latitude, as RFC 7946 wants them.
    """

    anchor: Anchor | None = None
    name: str = "geojson"
    in_map_folder: bool = False

    @property
    def options(self) -> Mapping[str, str]:
        """Where the map is on Earth."""
        return {"anchor": "LAT,LON,HEADING of the map's origin and x axis, degrees"}

    def with_options(self, options: Mapping[str, str]) -> GeoJsonExporter:
        """With that anchor."""
        read = read_options(_Options, self.name, options, "format", PluginError)
        return GeoJsonExporter(read.anchor)

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write map.geojson; `run` is not used."""
        path = folder / FILE
        place = self.anchor.lon_lat if self.anchor else _metres
        found = features(topological_map, place)
        lines = ",\n".join(json.dumps(f, ensure_ascii=False, allow_nan=False) for f in found)
        head = "" if self.anchor else f'"crs": {json.dumps(_crs())},\n'
        text = f'{{"type": "FeatureCollection", {head}"features": [\n{lines}\n]}}\n'
        path.write_text(text, encoding="utf-8")
        return [path]


def _crs() -> dict[str, object]:
    return {"type": "name", "properties": {"name": _MAP_FRAME}}


def _metres(x: float, y: float) -> tuple[float, float]:
    """Coordinates as they are, to 0.1 mm."""
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(f"position {x}, {y} is not finite")
    return round(x, 4) + 0.0, round(y, 4) + 0.0
