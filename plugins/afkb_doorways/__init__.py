"""Detectors: doorways (gaps between jambs, with lintels), and ceilings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector


@hookimpl
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """The doorway and the ceiling detector."""
    from afkb_doorways.ceiling import CeilingDetector
    from afkb_doorways.detector import DoorwayDetector
    from afkb_doorways.settings import DoorwaySettings

    return [DoorwayDetector(DoorwaySettings.of(knowledge_base)), CeilingDetector()]
