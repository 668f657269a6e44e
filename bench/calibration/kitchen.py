"""Labels of the real kitchen: the list that a person made by looking."""

from __future__ import annotations

from afkb.flow import Detection
from bench.detectors.kitchen import Kitchen, frame_number, label_of

TOGETHER = 50
"""Frames of the sequence that are drawn together: about three seconds of one look."""


class KitchenLabels:
    """Right if a claim lies on an entry that is so, wrong on one that is not; else untold."""

    def __init__(self, kitchen: Kitchen) -> None:
        self.building = kitchen.folder.name
        self._labels = kitchen.labels

    def scene(self, index: int, stamp: float) -> str:
        """A stretch of the sequence."""
        return f"{self.building} {frame_number(index) // TOGETHER}"

    def judge(
        self, claim: Detection, feature: str, index: int, thing: Detection
    ) -> tuple[bool, str] | None:
        """Whether the claim is so, and of which entry."""
        if claim.measures.get("is_floor"):
            return None
        entry = label_of(claim, feature, frame_number(index), self._labels)
        if entry is None or entry.expect == "either":
            return None
        return entry.expect == "found", entry.name
