"""Exporter: a map for geographic tools."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the GeoJSON exporter."""
    from afkb_geojson.exporter import GeoJsonExporter

    return [GeoJsonExporter()]
