"""Labels of the homes: which claims the list of things bears out."""

from __future__ import annotations

from typing import Any

import numpy as np

from afkb.flow import Detection, View
from afkb.knowledge import AfNet
from bench.beliefs import MEANT, meant, word_of
from bench.detectors.containers import kind_of, thing_at
from bench.detectors.data import Home
from bench.detectors.seen import SAME_STAMP_S
from bench.detectors.surfaces import NOT_A_SUPPORT, in_some_thing

CONTAINING = {"ContainAbility", "IntrinsicContainAbility"}
AFFORDS_FROM = 0.5
"""A category that has an afbit of this strength or more affords the feature."""
NO_LABEL = {"BlockAbility", "PassAbility"}
"""The truth of the homes lists neither walls nor doorways."""


class HomeLabels:
    """The truth of one home.

    - Support: right if its footprint lies in things' boxes, at a height that they have. The floor
      isn't judged: it would always be right.
    - Contain: right if its centre lies on a hollow or closed small thing, or a large container;
      intrinsically: if on a closed one.
    - Any other feature: what the ontology says of the category of the thing that it lies on,
      where the truth's word has one.
    """

    def __init__(self, home: Home, kb: AfNet) -> None:
        self.building = str(home.truth.get("scene", home.name))
        self._home, self._truth, self._kb = home.name, home.truth, kb
        self._supports = [t for t in self._things if t["category"] not in NOT_A_SUPPORT]
        self._stamps = np.array([v["stamp"] for v in self._truth["views"]])
        self._afforded: dict[str, set[str]] = {}

    @property
    def _things(self) -> list[dict[str, Any]]:
        things: list[dict[str, Any]] = self._truth["things"]
        return things

    def scene(self, view: View) -> str:
        """The room of the home."""
        nearest = int(np.abs(self._stamps - view.stamp).argmin())
        assert abs(self._stamps[nearest] - view.stamp) <= SAME_STAMP_S
        return f"{self._home} {self._truth['views'][nearest]['room']}"

    def judge(self, detection: Detection, feature: str, view: View) -> tuple[bool, str] | None:
        """Whether the claim is so, and of which thing."""
        if feature in NO_LABEL or detection.measures.get("is_floor"):
            return None
        if feature == "SupportAbility" and detection.about is None:
            return in_some_thing(detection, self._supports), _place(detection)
        thing = thing_at(detection, self._things)
        name = thing["name"] if thing else _place(detection)
        if feature in CONTAINING:
            kind = kind_of(thing) if thing else None
            return kind == "closed" if feature.startswith("Intrinsic") else kind is not None, name
        if thing is None or word_of(thing) not in MEANT:
            return None
        return feature in self._affords(word_of(thing)), name

    def _affords(self, word: str) -> set[str]:
        """The features of the categories that the word means, or of categories above them."""
        if word not in self._afforded:
            kinds = meant(word, self._kb)
            self._afforded[word] = {
                a.feature
                for a in self._kb.afbits
                if a.category in kinds and a.strength >= AFFORDS_FROM
            }
        return self._afforded[word]


def _place(detection: Detection) -> str:
    """A name for what is no listed thing: where it is, to a quarter of a metre."""
    x, y, z = (round(4 * float(v)) / 4 for v in detection.position_xyz)
    return f"at {x} {y} {z}"
