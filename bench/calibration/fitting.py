"""Fits the curves by which scores become probabilities."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import astuple, fields

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import expit

from afkb_mapping.calibration import Curve
from bench.calibration.samples import Sample

PULL = (0.25, 4.0, 4.0, 4.0, 4.0, 4.0)
"""Weight of the pull towards another curve (ridge; a Gaussian prior of deviation 2 on the
intercept, as base rates differ much between features, and 1/2 on the others)."""
AS_SCORED = Curve()


def fitted(
    samples: Sequence[Sample], towards: Curve = AS_SCORED, weights: Sequence[float] | None = None
) -> Curve:
    """The curve that makes the labels most likely, given the pull."""
    X = np.array([s.terms for s in samples])
    right = np.array([s.right for s in samples], float)
    weight = np.ones(len(samples)) if weights is None else np.asarray(weights)
    start = np.array(astuple(towards))
    bounds = [(0.0 if field.name == "slope" else None, None) for field in fields(Curve)]
    found = minimize(_loss, start, (X, right, weight, start), jac=True, bounds=bounds)
    return Curve(*(float(round(w, 4)) for w in found.x))


def _loss(
    w: NDArray[np.float64],
    X: NDArray[np.float64],
    right: NDArray[np.float64],
    weight: NDArray[np.float64],
    towards: NDArray[np.float64],
) -> tuple[float, NDArray[np.float64]]:
    logit = X @ w
    pull = np.array(PULL) * (w - towards)
    loss = weight @ (np.logaddexp(0, logit) - right * logit) + pull @ (w - towards) / 2
    return float(loss), X.T @ (weight * (expit(logit) - right)) + pull


def curves_of(samples: Sequence[Sample]) -> dict[str, Curve]:
    """Feature to curve for one detector's samples, each pulled towards that of all of them.

    In the common one, a feature counts by the root of its samples: what is claimed most, such as
    that things burn, should not set what is expected of the others.
    """
    if not samples:
        return {}
    counts = Counter(s.feature for s in samples)
    together = fitted(samples, weights=[counts[s.feature] ** -0.5 for s in samples])
    return {
        feature: fitted([s for s in samples if s.feature == feature], together)
        for feature in sorted(counts)
    }
