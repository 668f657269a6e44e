"""Detector: bodies that stand on a support, on a hidden one, or on the floor."""

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
    """The thing detector."""
    from afkb_mapping.calibration import calibrated
    from afkb_things.detector import ThingDetector

    return [calibrated(ThingDetector(), TABLE)]
