"""Detector: open and closed containers that stand on a support."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector


@hookimpl
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """The container detector, with the knowledge base's limits for containers."""
    from afkb_containers.detector import ContainerDetector
    from afkb_containers.settings import ContainerSettings

    return [ContainerDetector(ContainerSettings.from_knowledge(knowledge_base))]
