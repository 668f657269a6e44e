"""Turns what a detector scores into how often it is right (paper §II.D.i: a confidence measure).

A detector weighs cues as its author thought fit; how often a score comes true is counted, on
labelled frames, by `python -m bench.calibration fit`. A plugin ships what was counted as a small
table beside its code and hands out its detector as `calibrated(MyDetector(), table)`; nothing else
of it knows. Later stages see calibrated detections too, as does whoever calls the detector.

Platt's logistic curve (1999) with four more terms, of what every detection tells: errors grow with
distance, shrink with evidence, and depend on the size of a thing and on whether the image cuts it.

    logit p = intercept + slope · logit score + log_range · ln(range / 2 m)
              + log_pixels · ln(pixels / 1000) + log_size · ln(longest side / 0.3 m)
              + cut · (1 if the image cuts it, else 0)

A detector's curve is fitted with a pull towards "as scored", a feature's own with a pull towards
that of its detector, so that few examples change little. The slope isn't negative: a better score
never becomes a worse probability.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

from afkb.flow import Detection, View
from afkb.plugins.protocols import Detector

RANGE_M, PIXELS, SIZE_M = 2.0, 1000.0, 0.3
SCORE = "score"
"""The measure that holds a detection's best score: how far it affords anything, in its detector's
own judgement, however often such detections are right."""
SURE = 0.995
"""Scores and probabilities stay this far from certain: no table has examples for more."""
LEAST_RANGE_M, LEAST_SIZE_M = 0.2, 0.02


@dataclass(frozen=True, slots=True)
class Curve:
    """How a score of one feature becomes a probability; the default leaves it as it is."""

    intercept: float = 0.0
    slope: float = 1.0
    log_range: float = 0.0
    log_pixels: float = 0.0
    log_size: float = 0.0
    cut: float = 0.0

    @property
    def weights(self) -> tuple[float, ...]:
        """The coefficients, in their order."""
        return (
            self.intercept, self.slope, self.log_range, self.log_pixels, self.log_size, self.cut,
        )  # fmt: skip

    def probability(self, terms: Sequence[float]) -> float:
        """Probability of a detection with these terms.

        >>> round(Curve().probability((1.0, math.log(4.0), 0.0, 0.0, 0.0, 0.0)), 6)
        0.8
        """
        logit = sum(w * t for w, t in zip(self.weights, terms, strict=True))
        return min(max(1 / (1 + math.exp(-logit)), 1 - SURE), SURE)


def terms_of(detection: Detection, feature: str) -> tuple[float, ...]:
    """What a curve's coefficients are multiplied with, in their order."""
    score = min(max(detection.affordances[feature], 1 - SURE), SURE)
    return (
        1.0,
        math.log(score / (1 - score)),
        math.log(max(detection.range_m, LEAST_RANGE_M) / RANGE_M),
        math.log(max(detection.n_pixels, 1) / PIXELS),
        math.log(max(*detection.box.size_xyz, LEAST_SIZE_M) / SIZE_M),
        float(detection.cut_by_image),
    )


class CalibratedDetector:
    """A detector whose scores have become probabilities; `scorer` is the detector itself."""

    def __init__(self, scorer: Detector, curves: Mapping[str, Curve]) -> None:
        self.scorer = scorer
        self.curves = curves

    @property
    def name(self) -> str:
        """The detector's own name."""
        return self.scorer.name

    @property
    def affordances(self) -> tuple[str, ...]:
        """What it can report."""
        return self.scorer.affordances

    @property
    def stage(self) -> int:
        """The detector's own stage."""
        return self.scorer.stage

    @property
    def by_default(self) -> bool:
        """Whether it runs where no detector is named."""
        return getattr(self.scorer, "by_default", True)

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """What the detector sees, with probabilities that mean what they say."""
        return [self.calibrate(d) for d in self.scorer.detect(view, earlier)]

    def calibrate(self, scored: Detection) -> Detection:
        """The same detection with probabilities instead of scores."""
        return replace(
            scored,
            affordances={
                feature: _probability(self.curves.get(feature), scored, feature)
                for feature in scored.affordances
            },
            measures={**scored.measures, SCORE: max(scored.affordances.values())},
        )


def _probability(curve: Curve | None, scored: Detection, feature: str) -> float:
    """What is impossible stays so; of a feature that nobody labelled the score is all we know."""
    score = scored.affordances[feature]
    return score if curve is None or score <= 0 else curve.probability(terms_of(scored, feature))


def calibrated(detector: Detector, table: Path) -> Detector:
    """The detector with the curves of a table; the detector as it is where there are none yet."""
    curves = read_curves(table, detector.name)
    return CalibratedDetector(detector, curves) if curves else detector


def read_curves(table: Path, detector: str) -> dict[str, Curve]:
    """Feature to curve, of one detector; no curves where the plugin has no table yet.

    Columns: detector, feature, and the coefficients of a `Curve`; others say what they were
    counted from.
    """
    if not table.is_file():
        return {}
    rows = csv.DictReader(table.read_text(encoding="utf-8").splitlines())
    return {
        row["feature"]: Curve(*(float(row[term.name]) for term in fields(Curve)))
        for row in rows
        if row["detector"] == detector
    }
