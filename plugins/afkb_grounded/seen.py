"""What a view's earlier detectors told of, thing by thing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from afkb.flow import Detection

SURFACE, BODY, OPENING, UPRIGHT, GAP, PART = (
    "surface", "body", "opening", "upright", "gap", "part",
)  # fmt: skip
OPEN_FROM = 0.3
"""A body that contains with at least that probability, and whose hollow was measured, is looked at
as an opening, too."""


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """One thing of a view: the detection that first told of it, and those that add to it.

    `index`: of the first among the view's detections, None for one that none told of;
    `kinds`: what it is looked at as.
    """

    index: int | None
    first: Detection
    kinds: tuple[str, ...]
    affordances: dict[str, float]
    measures: dict[str, float] = field(default_factory=dict)


def things_of(earlier: Sequence[Detection]) -> list[Seen]:
    """The things of a view, in the order in which they were first told of; no floor."""
    told: dict[int, list[Detection]] = {}
    roots: list[int] = []
    for index, detection in enumerate(earlier):
        root = index if detection.about is None else roots[detection.about]
        roots.append(root)
        told.setdefault(root, []).append(detection)
    things = (_thing(root, detections) for root, detections in told.items())
    return [thing for thing in things if not thing.measures.get("is_floor")]


def _thing(index: int, detections: list[Detection]) -> Seen:
    affordances: dict[str, float] = {}
    measures: dict[str, float] = {}
    for detection in detections:
        measures |= detection.measures
        for name, p in detection.affordances.items():
            affordances[name] = max(p, affordances.get(name, 0.0))
    return Seen(index, detections[0], _kinds(detections[0], affordances, measures),
                affordances, measures)  # fmt: skip


def _kinds(
    first: Detection, affordances: dict[str, float], measures: dict[str, float]
) -> tuple[str, ...]:
    if first.segment_xy is not None:
        return (UPRIGHT,)
    best = max(first.affordances, key=lambda name: first.affordances[name])
    if best == "PassAbility":
        return (GAP,)
    if best == "SupportAbility":
        return (SURFACE,)
    open_ = affordances.get("ContainAbility", 0.0) >= OPEN_FROM and "depth" in measures
    return (BODY, OPENING) if open_ else (BODY,)
