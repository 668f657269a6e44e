"""Detector: the same surfaces by Open3D's planar patches, to swap in and to compare with."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector


@hookimpl
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """The detector, with the knowledge base's limits for supports and bounds."""
    from afkb_open3d_patches.detector import PlanarPatchDetector

    return [PlanarPatchDetector.from_knowledge(knowledge_base)]
