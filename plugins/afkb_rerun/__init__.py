"""Exporter and viewer for Rerun, an extra: `rerun`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter, Viewer


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the exporter of recordings."""
    from afkb_rerun.exporter import RerunExporter

    return [RerunExporter()]


@hookimpl
def afkb_viewers(knowledge_base: AfNet) -> Iterable[Viewer]:
    """Return the viewer."""
    from afkb_rerun.viewer import RerunViewer

    return [RerunViewer()]
