"""What a view's earlier detectors told of, thing by thing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from afkb.flow import Detection
from afkb_mapping.one_per_thing import told_of_each

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


def things_of(earlier: Sequence[Detection], told_by: Mapping[str, str]) -> list[Seen]:
    """The things of a view, in the order in which they were first told of; no floor, no ceiling.

    `told_by`: a feature that has a detector of its own, to the kind of thing that affords it.
    """
    told = told_of_each(earlier)
    things = [_thing(root, detections, told_by) for root, detections in told.items()]
    return [thing for thing in things if thing.kinds and not thing.measures.get("is_floor")]


def _thing(index: int, detections: list[Detection], told_by: Mapping[str, str]) -> Seen:
    affordances: dict[str, float] = {}
    measures: dict[str, float] = {}
    for detection in detections:
        measures |= detection.measures
        for name, p in detection.affordances.items():
            affordances[name] = max(p, affordances.get(name, 0.0))
    open_ = "depth" in measures and any(
        p >= OPEN_FROM for name, p in affordances.items() if told_by.get(name) == OPENING
    )
    kinds = _kinds(detections[0], open_, told_by)
    return Seen(index, detections[0], kinds, affordances, measures)


def _kinds(first: Detection, open_: bool, told_by: Mapping[str, str]) -> tuple[str, ...]:
    """By what it affords most surely; what no own detector tells of is a body."""
    best = max(first.affordances, key=lambda name: first.affordances[name])
    kind = told_by.get(best, BODY)
    if kind == UPRIGHT:
        return (UPRIGHT,) if first.segment_xy is not None else ()
    if kind in (SURFACE, GAP):
        return (kind,)
    return (BODY, OPENING) if open_ else (BODY,)
