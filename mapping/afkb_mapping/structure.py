"""What bounds rooms and joins them, and is no thing in them: walls, passages, ceilings."""

from __future__ import annotations

from afkb.flow import Detection

PASSAGE = "PassAbility"


def is_structure(detection: Detection) -> bool:
    """Whether a detection is of a bound, a passage or a ceiling."""
    return detection.segment_xy is not None or is_passage(detection) or is_ceiling(detection)


def is_passage(detection: Detection) -> bool:
    """Whether passing is what a detection is of: an opening."""
    p = detection.affordances.get(PASSAGE)
    return p is not None and p == max(detection.affordances.values())


def is_ceiling(detection: Detection) -> bool:
    """Whether a detection is of the ceiling."""
    return bool(detection.measures.get("is_ceiling", 0.0))
