"""How well probabilities agree with what came true."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import rankdata

BINS = 10
RESAMPLED = 300
"""Bootstrap samples: the ends of a 90 % interval then are known to about 1 % of its length."""

Floats = NDArray[np.float64]
Classes = NDArray[np.str_]


@dataclass(frozen=True, eq=False)
class Bin:
    """One bin of a reliability diagram: mean probability, share that is right, and how many."""

    stated: float
    right: float
    count: int


def reliability(p: Floats, right: Floats, bins: int = BINS) -> list[Bin]:
    """The bins of equal width that hold anything (Guo et al., ICML 2017)."""
    which = np.minimum((p * bins).astype(int), bins - 1)
    held = [which == b for b in range(bins)]
    return [Bin(float(p[h].mean()), float(right[h].mean()), int(h.sum())) for h in held if h.any()]


def expected_calibration_error(p: Floats, right: Floats, bins: int = BINS) -> float:
    """Mean distance of stated from found, over bins, by their counts.

    >>> expected_calibration_error(np.array([0.7, 0.7]), np.array([1.0, 0.0]))
    0.2
    """
    held = reliability(p, right, bins)
    error = sum(b.count * abs(b.stated - b.right) for b in held) / len(p)
    return float(round(error, 12))


def brier(p: Floats, right: Floats) -> float:
    """Mean square of stated minus what came true."""
    return float(np.mean((p - right) ** 2))


def brier_skill(p: Floats, right: Floats, classes: Classes) -> float | None:
    """1 - Brier / Brier of the base rates: 0 for these constants, 1 for an oracle.

    The base rate is that of each class (detector and feature) among the judged samples themselves:
    the best constants there are. None where all samples of each class are alike.
    """
    base = np.zeros(len(p))
    for name in np.unique(classes):
        base[classes == name] = right[classes == name].mean()
    worst = brier(base, right)
    return 1 - brier(p, right) / worst if worst > 0 else None


def area_under_curve(p: Floats, right: Floats, classes: Classes) -> float | None:
    """Probability that a right one is stated above a wrong one of its class, ties half.

    (Mann-Whitney, over all such pairs.) None where there is no such pair.
    """
    above = pairs = 0.0
    for name in np.unique(classes):
        own, so = p[classes == name], right[classes == name]
        n_right = float(so.sum())
        above += float(rankdata(own)[so > 0].sum()) - n_right * (n_right + 1) / 2
        pairs += n_right * (len(so) - n_right)
    return above / pairs if pairs else None


def summary(p: Floats, right: Floats, classes: Classes) -> dict[str, Any]:
    """All of these, with the counts."""
    return {
        "samples": len(p),
        "right": float(right.mean()),
        "stated": float(p.mean()),
        "ece": expected_calibration_error(p, right),
        "brier_skill": brier_skill(p, right, classes),
        "auc": area_under_curve(p, right, classes),
    }


def bootstrapped(
    p: Floats, right: Floats, classes: Classes, scenes: Classes, rng: np.random.Generator
) -> dict[str, list[float]]:
    """90 % interval of each measure when whole scenes are drawn with replacement.

    What is seen in one room or cloud hangs together; single samples would seem surer.
    """
    names, which = np.unique(scenes, return_inverse=True)
    members = [np.flatnonzero(which == i) for i in range(len(names))]
    drawn: dict[str, list[float]] = {"ece": [], "brier_skill": [], "auc": []}
    for _ in range(RESAMPLED):
        picked = np.concatenate([members[i] for i in rng.integers(0, len(names), len(names))])
        found = summary(p[picked], right[picked], classes[picked])
        for name, values in drawn.items():
            if found[name] is not None:
                values.append(found[name])
    return {n: [float(q) for q in np.percentile(v, [5, 95])] for n, v in drawn.items() if v}
