"""Labels of the homes: which claims the list of things bears out."""

from __future__ import annotations

from typing import Any

import numpy as np

from afkb.flow import Detection
from afkb.knowledge import AfNet
from bench.beliefs import MEANT, kinds_of, word_of
from bench.detectors.containers import kind_of, thing_at
from bench.detectors.data import Home
from bench.detectors.seen import MARGIN_M, inside
from bench.detectors.surfaces import HEIGHT_TOLERANCE_M, NOT_A_SUPPORT, in_some_thing

CONTAINING = {"ContainAbility", "IntrinsicContainAbility"}
AFFORDS_FROM = 0.5
"""A category that has an afbit of this strength or more affords the feature."""
NO_LABEL = {"BlockAbility", "PassAbility"}
"""The truth of the homes lists neither walls nor doorways."""


UNTOLD = (
    "bathtub", "bed", "coffee_table", "dishwasher", "floor_lamp", "plant", "shelf", "sink",
    "sofa_chair", "table_lamp", "toilet", "towel_rack",
)  # fmt: skip
"""Things with more upward surfaces than the one that the truth gives the height of, real ones or
not: boards, arms, rims, racks, basins, pots. Of these nothing is told."""
ALSO_MEANT = {
    "carpet": ("Carpet", "Rug"),
    "door": ("Door",),
    "floor_lamp": ("FloorLamp",),
    "mirror": ("Mirror",),
    "picture": ("Picture", "Painting"),
    "plant": ("Plant",),
    "range_hood": ("RangeHood",),
    "table_lamp": ("TableLamp",),
    "towel_rack": ("TowelRail",),
    "window": ("Window",),
}
"""Words of the truth beside those that beliefs are held against."""
MOSTLY = 0.6
SAME_BODY_IOU = 0.25
"""A body is seen from one side and misses up to three quarters of its box, as a carton does that is
seen from its narrow side; two things in one body, or half a sofa, share less."""


class HomeLabels:
    """The truth of one home.

    - Support: right if it lies in a thing's box at the height of its upward surface; wrong at other
      heights of what has no other such surface, as a cabinet hasn't, and where nothing is. The
      floor isn't judged: it would always be right.
    - Contain: right if its centre lies on a hollow or closed small thing, or a large container;
      intrinsically: if on a closed one, and untold on a hollow one: its inside may be hidden.
    - Dispose, of a body that was cut out: right if it is one thing, by its box.
    - Any other feature but grasps: wrong of what is no surface and no one thing; else what the
      ontology says of the category, where the truth's word has one. Grasps have no label: the
      ontology lists the usual ones, and a body that is held otherwise is no error.
    """

    def __init__(self, home: Home, kb: AfNet) -> None:
        self.building = str(home.truth.get("scene", home.name))
        self._home, self._kb = home.name, kb
        self._things: list[dict[str, Any]] = home.truth["things"]
        self._flat = [t for t in self._things if t["category"] not in NOT_A_SUPPORT]
        self._views = home.truth["views"]
        self._stamps = np.array([v["stamp"] for v in self._views])
        self._afforded: dict[str, set[str]] = {}

    def scene(self, index: int, stamp: float) -> str:
        """The room of the home."""
        nearest = int(np.abs(self._stamps - stamp).argmin())
        return f"{self._home} {self._views[nearest]['room']}"

    def judge(
        self, claim: Detection, feature: str, index: int, thing: Detection
    ) -> tuple[bool, str] | None:
        """Whether the claim is so, and of which thing."""
        if feature in NO_LABEL or thing.measures.get("is_floor") or self._is_grasp(feature):
            return None
        meant = thing_at(claim, self._things)
        told: bool | None
        if feature in CONTAINING:
            told = _contains(kind_of(meant) if meant else None, feature)
        else:
            told = self._is_one(thing, meant)
            if told and claim.about is not None:
                told = self._afforded_by(meant, feature)
        return None if told is None else (told, meant["name"] if meant else _place(claim))

    def _is_grasp(self, feature: str) -> bool:
        known = self._kb.features.get(feature)
        return known is not None and known.kind == "grasp"

    def _is_one(self, thing: Detection, meant: dict[str, Any] | None) -> bool | None:
        """Whether a surface is one, or a body one thing; None of what is neither."""
        if "area" in thing.measures and "SupportAbility" in thing.affordances:
            return self._supports(thing)
        if thing.pixels is None or "stand" not in thing.measures:
            return None
        return meant is not None and _iou(thing, meant) >= SAME_BODY_IOU

    def _supports(self, claim: Detection) -> bool | None:
        height = claim.measures["height"]
        around = [
            t
            for t in self._flat
            if t["min"][2] - MARGIN_M <= height <= t["max"][2] + HEIGHT_TOLERANCE_M
            and inside(t, claim.footprint_xy).mean() > MOSTLY
        ]
        if not around:  # a run of furniture, or nothing
            return in_some_thing(claim, self._flat)
        if any(abs(height - t["top_height"]) <= HEIGHT_TOLERANCE_M for t in around):
            return True
        at_box_top = any(abs(height - t["max"][2]) <= HEIGHT_TOLERANCE_M for t in around)
        if at_box_top or any(t["category"] in UNTOLD for t in around):
            return None
        return False

    def _afforded_by(self, thing: dict[str, Any] | None, feature: str) -> bool | None:
        """By the categories that the truth's word means, in the ontology."""
        word = word_of(thing) if thing else ""
        meant = MEANT.get(word) or ALSO_MEANT.get(word)
        if meant is None:
            return None
        if word not in self._afforded:
            kinds = kinds_of(meant, self._kb)
            self._afforded[word] = {
                a.feature
                for a in self._kb.afbits
                if a.category in kinds and a.strength >= AFFORDS_FROM
            }
        return feature in self._afforded[word]


def _contains(kind: str | None, feature: str) -> bool | None:
    if feature == "ContainAbility" or kind is None:
        return kind is not None
    # Whether the inside of what is hollow is in sight, the truth doesn't say.
    return {"closed": True, "large": False}.get(kind)


def _iou(claim: Detection, thing: dict[str, Any]) -> float:
    """Shared volume of the claim's upright bounds and the thing's box, by that of their union."""
    low = np.array([*claim.footprint_xy.min(axis=0), claim.box.bottom])
    high = np.array([*claim.footprint_xy.max(axis=0), claim.box.top])
    a, b = np.array(thing["min"]), np.array(thing["max"])
    shared = float(np.prod(np.clip(np.minimum(high, b) - np.maximum(low, a), 0, None)))
    return shared / max(float(np.prod(high - low)) + float(np.prod(b - a)) - shared, 1e-9)


def _place(claim: Detection) -> str:
    """A name for what is no listed thing: where it is, to a quarter of a metre."""
    x, y, z = (round(4 * float(v)) / 4 for v in claim.position_xyz)
    return f"at {x} {y} {z}"
