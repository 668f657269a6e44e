"""Exporters: a map's RDF, as it is stored and as JSON-LD."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the exporters of RDF."""
    from afkb_rdf.exporters import JsonLdExporter, TurtleExporter

    return [TurtleExporter(knowledge_base), JsonLdExporter(knowledge_base)]
