"""Detector: every feature that the ontology grounds on measures of what was seen."""

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
    """The grounded detector; it reads the groundings when it is first used."""
    from afkb_grounded.detector import GroundedDetector
    from afkb_mapping.calibration import calibrated

    return [calibrated(GroundedDetector(knowledge_base), TABLE)]
