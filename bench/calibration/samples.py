"""Labelled scores: what a detector said of a view, and whether it is so."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from afkb.flow import Detection, View
from afkb_mapping.calibration import CalibratedDetector, Curve, terms_of


@dataclass(frozen=True)
class Sample:
    """One score of one feature with its label; `p` is what the shipped table makes of it.

    `building` is what folds are made of, `scene` (a room, a cloud) what is drawn together, `thing`
    names what was seen, in its building.
    """

    building: str
    scene: str
    thing: str
    detector: str
    feature: str
    score: float
    p: float
    range_m: float
    n_pixels: int
    right: bool

    @property
    def terms(self) -> tuple[float, float, float, float]:
        """What a curve's coefficients are multiplied with."""
        return terms_of(self.score, self.range_m, self.n_pixels)

    def by(self, curve: Curve) -> float:
        """The probability that a curve makes of it."""
        return curve.probability(self.score, self.range_m, self.n_pixels)


class Labels(Protocol):
    """The truth of a scene."""

    building: str

    def scene(self, view: View) -> str:
        """What is drawn together with it: the room, or the cloud."""
        ...

    def judge(self, detection: Detection, feature: str, view: View) -> tuple[bool, str] | None:
        """Whether the claim is so, and the thing's name; None where the truth can't tell."""
        ...


def samples_of(views: Iterable[View], detectors: Sequence[Any], labels: Labels) -> Iterator[Sample]:
    """Every labelled score in the views.

    Detectors see calibrated detections of lower stages, as they do in a run; what they score
    themselves is taken before and after their own table.
    """
    for view in views:
        found: list[Detection] = []
        for stage in sorted({d.stage for d in detectors}):
            earlier = tuple(found)
            for detector in (d for d in detectors if d.stage == stage):
                for scored, stated in _both(detector, view, earlier):
                    found.append(stated)
                    yield from _labelled(scored, stated, earlier, view, labels)


def _both(
    detector: Any, view: View, earlier: Sequence[Detection]
) -> Iterator[tuple[Detection, Detection]]:
    if isinstance(detector, CalibratedDetector):
        for scored in detector.scorer.detect(view, earlier):
            yield scored, detector.calibrate(scored)
    else:
        for scored in detector.detect(view, earlier):
            yield scored, scored


def _labelled(
    scored: Detection,
    stated: Detection,
    earlier: Sequence[Detection],
    view: View,
    labels: Labels,
) -> Iterator[Sample]:
    for feature, score in scored.affordances.items():
        verdict = labels.judge(scored, feature, view)
        if verdict is None or score <= 0:
            continue
        yield Sample(
            building=labels.building,
            scene=labels.scene(view),
            thing=verdict[1],
            detector=scored.detector,
            feature=feature,
            score=score,
            p=stated.affordances[feature],
            range_m=scored.range_m,
            n_pixels=scored.n_pixels,
            right=verdict[0],
        )
