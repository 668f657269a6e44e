"""Fits the curves by which scores become probabilities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, fields

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import expit

from afkb_mapping.calibration import ANY, Curve
from bench.calibration.samples import Sample

PULL = (1.0, 4.0, 4.0, 4.0, 4.0, 4.0)
"""Weight of the pull towards `AS_SCORED` (ridge; a Gaussian prior of deviation 1 on the intercept,
1/2 on the others): a handful of examples can't turn a curve."""
AS_SCORED = np.array(astuple(Curve()))
FEW_RIGHT = FEW_WRONG = 5
"""A feature with fewer right or wrong examples than this shares the curve of the detector."""


def fitted(samples: Sequence[Sample]) -> Curve:
    """The curve that makes the labels most likely, given the pull."""
    X = np.array([s.terms for s in samples])
    right = np.array([s.right for s in samples], float)
    bounds = [(0.0 if field.name == "slope" else None, None) for field in fields(Curve)]
    found = minimize(_loss, AS_SCORED, (X, right), jac=True, bounds=bounds)
    return Curve(*(float(round(w, 4)) for w in found.x))


def _loss(
    w: NDArray[np.float64], X: NDArray[np.float64], right: NDArray[np.float64]
) -> tuple[float, NDArray[np.float64]]:
    logit = X @ w
    pull = np.array(PULL) * (w - AS_SCORED)
    loss = np.sum(np.logaddexp(0, logit) - right * logit) + pull @ (w - AS_SCORED) / 2
    return float(loss), X.T @ (expit(logit) - right) + pull


def curves_of(samples: Sequence[Sample]) -> dict[str, Curve]:
    """Feature to curve for one detector's samples; `ANY` from all of them."""
    if not samples:
        return {}
    curves = {ANY: fitted(samples)}
    for feature in sorted({s.feature for s in samples}):
        own = [s for s in samples if s.feature == feature]
        right = sum(s.right for s in own)
        if right >= FEW_RIGHT and len(own) - right >= FEW_WRONG:
            curves[feature] = fitted(own)
    return curves
