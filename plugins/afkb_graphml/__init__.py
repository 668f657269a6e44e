"""Exporters: the graph as GraphML, and the paper's output form of it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the exporters of graphs."""
    from afkb_graphml.exporters import GraphMLExporter, PaperExporter

    return [GraphMLExporter(), PaperExporter()]
