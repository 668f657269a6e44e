"""Exporter: a map as tables."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the exporter of tables."""
    from afkb_tables.exporter import CsvExporter

    return [CsvExporter()]
