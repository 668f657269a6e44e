"""Detector: horizontal and vertical surfaces in depth."""

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
    """The surface detector, with the knowledge base's limits for supports and bounds."""
    from afkb_mapping.calibration import calibrated
    from afkb_surfaces.detector import SurfaceDetector
    from afkb_surfaces.settings import SurfaceSettings

    return [calibrated(SurfaceDetector(SurfaceSettings.from_knowledge(knowledge_base)), TABLE)]
