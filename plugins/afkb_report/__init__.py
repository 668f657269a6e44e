"""Exporter: report.html, a page that shows the map."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the report."""
    from afkb_report.exporter import ReportExporter

    return [ReportExporter()]
