"""Detector: open and closed containers that stand on a support."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector

TABLE = Path(__file__).with_name("calibration.csv")
"""How often each score comes true (`afkb_mapping.calibration`)."""


@hookimpl
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """The container detector, with the knowledge base's limits for containers."""
    from afkb_containers.detector import ContainerDetector
    from afkb_containers.settings import ContainerSettings
    from afkb_mapping.calibration import calibrated

    return [calibrated(ContainerDetector(ContainerSettings.from_knowledge(knowledge_base)), TABLE)]
