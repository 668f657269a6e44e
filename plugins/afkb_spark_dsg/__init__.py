"""Exporter: a scene graph that spark_dsg loads."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Exporter


@hookimpl
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return the exporter of scene graphs."""
    from afkb_spark_dsg.exporter import SparkDsgExporter

    return [SparkDsgExporter()]
