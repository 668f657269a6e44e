"""Detector: bodies that stand on a support, on a hidden one, or on the floor."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector


@hookimpl
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """The thing detector."""
    from afkb_things.detector import ThingDetector

    return [ThingDetector()]
