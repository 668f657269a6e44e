"""Detector: bounds (walls) as line segments in laser scans."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector


@hookimpl
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """The laser bound detector."""
    from afkb_laser_bounds.detector import LaserBoundDetector

    return [LaserBoundDetector()]
