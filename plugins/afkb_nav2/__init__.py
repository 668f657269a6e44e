"""Exporter: occupancy grid for nav2's map_server."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the nav2 exporter."""
    from afkb_nav2.exporter import Nav2Exporter

    return [Nav2Exporter()]
