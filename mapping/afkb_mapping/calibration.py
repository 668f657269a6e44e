"""Turns what a detector scores into how often it is right (paper §II.D.i: a confidence measure).

A detector weighs cues as its author thought fit; how often a score comes true is counted, on
labelled frames, by `python -m bench.calibration fit`. A plugin ships what was counted as a small
table beside its code and hands out its detector as `calibrated(MyDetector(), table)`; nothing else
of it knows. Later stages see calibrated detections too, as does whoever calls the detector.

Platt's logistic curve (1999) with two more terms, as errors grow with distance and shrink with
evidence:

    logit p = intercept + slope · logit score + log_range · ln(range / 2 m)
              + log_pixels · ln(pixels / 1000)

It is fitted with a pull towards "as scored", so that few examples change little. The slope isn't
negative: a better score never becomes a worse probability.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.resources.abc import Traversable
from pathlib import Path

from afkb.flow import Detection, View
from afkb.plugins.protocols import Detector

ANY = "*"
"""In a table: every feature that has no row of its own, as its examples were too few."""
RANGE_M, PIXELS = 2.0, 1000.0
SURE = 0.995
"""Scores and probabilities stay this far from certain: no table has examples for more."""
LEAST_RANGE_M = 0.2


@dataclass(frozen=True, slots=True)
class Curve:
    """How a score of one feature becomes a probability; the default leaves it as it is."""

    intercept: float = 0.0
    slope: float = 1.0
    log_range: float = 0.0
    log_pixels: float = 0.0

    def probability(self, score: float, range_m: float, n_pixels: int) -> float:
        """Probability of a score at a distance (m), by evidence of so many pixels.

        >>> round(Curve().probability(0.8, 3.0, 500), 6)
        0.8
        """
        if score <= 0:
            return 0.0
        weights = (self.intercept, self.slope, self.log_range, self.log_pixels)
        terms = terms_of(score, range_m, n_pixels)
        logit = sum(w * t for w, t in zip(weights, terms, strict=True))
        return min(max(1 / (1 + math.exp(-logit)), 1 - SURE), SURE)


def terms_of(score: float, range_m: float, n_pixels: int) -> tuple[float, float, float, float]:
    """What a curve's coefficients are multiplied with, in their order."""
    kept = min(max(score, 1 - SURE), SURE)
    return (
        1.0,
        math.log(kept / (1 - kept)),
        math.log(max(range_m, LEAST_RANGE_M) / RANGE_M),
        math.log(max(n_pixels, 1) / PIXELS),
    )


class CalibratedDetector:
    """A detector whose scores have become probabilities; `scorer` is the detector itself."""

    def __init__(self, scorer: Detector, curves: Mapping[str, Curve]) -> None:
        self.scorer = scorer
        self.curves = curves
        self.name, self.affordances, self.stage = scorer.name, scorer.affordances, scorer.stage

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """What the detector sees, with probabilities that mean what they say."""
        return [self.calibrate(d) for d in self.scorer.detect(view, earlier)]

    def calibrate(self, scored: Detection) -> Detection:
        """The same detection with probabilities instead of scores."""
        return replace(
            scored,
            affordances={
                feature: self._curve(feature).probability(score, scored.range_m, scored.n_pixels)
                for feature, score in scored.affordances.items()
            },
        )

    def _curve(self, feature: str) -> Curve:
        return self.curves.get(feature) or self.curves.get(ANY) or Curve()


def calibrated(detector: Detector, table: Traversable | Path) -> Detector:
    """The detector with the curves of a table, as `bench.calibration` writes it."""
    return CalibratedDetector(detector, read_curves(table, detector.name))


def read_curves(table: Traversable | Path, detector: str) -> dict[str, Curve]:
    """Feature to curve, of one detector; no curves where the plugin has no table yet.

    Columns: detector, feature, intercept, slope, log_range, log_pixels; others say what they were
    counted from.
    """
    if not table.is_file():
        return {}
    rows = csv.DictReader(table.read_text(encoding="utf-8").splitlines())
    names = ("intercept", "slope", "log_range", "log_pixels")
    return {
        row["feature"]: Curve(*(float(row[name]) for name in names))
        for row in rows
        if row["detector"] == detector
    }
