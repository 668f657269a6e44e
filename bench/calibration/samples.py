"""Labelled scores: what a detector said of a view, and whether it is so."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from afkb.flow import Detection
from afkb_mapping.calibration import Curve, terms_of
from bench.detectors.seen import Run


@dataclass(frozen=True)
class Sample:
    """One score of one feature with its label; `p` is what the shipped table makes of it.

    `building` is what folds are made of, `scene` (a room, a cloud) what is drawn together, `thing`
    names what was seen, in its building; `terms` are what a curve weighs.
    """

    building: str
    scene: str
    thing: str
    detector: str
    feature: str
    score: float
    p: float
    range_m: float
    terms: tuple[float, ...]
    right: bool

    def by(self, curve: Curve) -> float:
        """The probability that a curve makes of it."""
        return curve.probability(self.terms)


class Labels(Protocol):
    """The truth of a recording."""

    building: str

    def scene(self, index: int, stamp: float) -> str:
        """What is drawn together with a view: its room, or its cloud."""
        ...

    def judge(
        self, claim: Detection, feature: str, index: int, thing: Detection
    ) -> tuple[bool, str] | None:
        """Whether a claim is so, and the thing's name; None where the truth can't tell.

        `thing`: the detection that the claim is about, or the claim itself.
        """
        ...


def samples_of(run: Run, labels: Labels) -> Iterator[Sample]:
    """Every labelled score of a recording."""
    for (index, stated), scored, stamp in zip(run.views, run.scored, run.stamps, strict=True):
        scene = labels.scene(index, stamp)
        for before, after in zip(scored, stated, strict=True):
            thing = _told_first(before, scored)
            for feature, score in before.affordances.items():
                verdict = labels.judge(before, feature, index, thing)
                if verdict is None or score <= 0:
                    continue
                yield Sample(
                    building=labels.building,
                    scene=scene,
                    thing=verdict[1],
                    detector=before.detector,
                    feature=feature,
                    score=score,
                    p=after.affordances[feature],
                    range_m=before.range_m,
                    terms=terms_of(before, feature),
                    right=verdict[0],
                )


def _told_first(claim: Detection, scored: Sequence[Detection]) -> Detection:
    while claim.about is not None:
        claim = scored[claim.about]
    return claim
