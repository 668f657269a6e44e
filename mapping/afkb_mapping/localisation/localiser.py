"""Self-localisation in a stored map: a pose with its probability and covariance, or lost."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from afkb_mapping.localisation.bands import HeightBands
from afkb_mapping.localisation.candidates import Candidate
from afkb_mapping.localisation.expectation import surroundings_of
from afkb_mapping.localisation.readings import Readings, joined
from afkb_mapping.localisation.search import Search
from afkb_mapping.localisation.sensor_model import (
    HIT,
    INDEPENDENT_DEPTH,
    INDEPENDENT_LASER,
    LASER_ROW,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Odds:
    """Logistic model of whether the likeliest pose is right, of a sensor; log-odds.

    - `lead`: for the root of by how much its log-likelihood leads those of all others together.
    - `fit`: for its log-likelihood over what is met, per independent reading.
    - `blocked`: for the share of readings that meet something: from near a wall much is explained
      by any wall.
    - `whole`: for how much the fit is better than `WHOLE_FIT`.
    """

    lead: float
    fit: float
    blocked: float
    whole: float
    at_zero: float

    def probability(self, lead: float, fit: float, blocked: float) -> float:
        """That the likeliest pose is right."""
        logit = self.lead * math.sqrt(max(lead, 0.0)) + self.fit * fit + self.blocked * blocked
        logit += self.whole * max(fit - WHOLE_FIT, 0.0) + self.at_zero
        return 1 / (1 + math.exp(-logit))


DEPTH = Odds(lead=1.86, fit=9.44, blocked=-5.34, whole=0.0, at_zero=3.15)
LASER = Odds(lead=3.65, fit=0.59, blocked=0.0, whole=6.0, at_zero=-4.82)
"""Fitted by logistic regression to views of two homes, each asked in a map of every second view of
its own and in the other's, where no answer is right; a laser with whole scans and with 60 % of the
beams nonsense. Only `whole` is not: no scan of theirs was whole and in doubt."""
WHOLE_FIT = -0.5
"""Whole scans fit their own home to -0.25 at least, another's to -0.69 at most."""
FARTHEST_LEAD = 15.0
"""A view's. More tells no more: what is left to err is that the place is not in the map."""
LEAST_WEIGHT = 5.0
"""Fewer independent readings than these tell nothing of how well a pose fits."""
SURE = 0.5
"""Below this probability the robot is lost: what is told is more likely right than wrong."""
STEP_M, STEP_RAD = 0.05, math.radians(2.0)
LEAST_SIGMAS = (0.02, 0.02, math.radians(0.5))
"""No pose is known better than the map's cells allow."""


@dataclass(frozen=True, slots=True, eq=False)
class Located:
    """A pose of the base in the map frame (m, rad), its probability, and covariance (3, 3).

    `lost`: no pose is probable enough; the likeliest one is told all the same.
    """

    lost: bool
    x: float
    y: float
    yaw: float
    probability: float
    covariance: Array


class Localiser:
    """Tells where views were taken in one map, with no idea of where that might be."""

    def __init__(self, bands: HeightBands) -> None:
        self._search = Search(surroundings_of(bands))

    def locate(self, views: Sequence[Readings]) -> Located:
        """Where the base of the last of some views stands.

        `views`: what each has read, in the frame of that base by odometry.
        """
        found = self._search.candidates(views)
        if not found:
            return Located(True, math.nan, math.nan, math.nan, 0.0, np.full((3, 3), math.nan))
        best = found[0]
        probability = _probability(found, views)
        return Located(
            probability < SURE,
            best.x,
            best.y,
            best.yaw,
            probability,
            self._covariance(best, views[-1]),
        )

    def _covariance(self, best: Candidate, readings: Readings) -> Array:
        """By how steeply the likelihood falls around it."""
        steps = np.array([STEP_M, STEP_M, STEP_RAD])
        pose = np.array([best.x, best.y, best.yaw])
        around = [pose]
        for k in range(3):
            for sign in (-1, 1):
                moved = pose.copy()
                moved[k] += sign * steps[k]
                around.append(moved)
        values = self._search.log_likelihood_at(np.array(around), readings)
        fall = 2 * values[0] - values[1::2] - values[2::2]
        information = np.maximum(fall, 1e-3) / steps**2
        return np.diag(1 / information + np.square(LEAST_SIGMAS))


def _probability(found: Sequence[Candidate], views: Sequence[Readings]) -> float:
    """Of the best candidate; a camera's odds ask for a better fit than those of a laser alone."""
    readings = joined(views)
    logs = np.array([c.log_likelihood for c in found])
    lead = -float(logsumexp(logs[1:] - logs[0])) if len(logs) > 1 else math.inf
    met = readings.kind == HIT
    by_laser = readings.row == LASER_ROW
    weights = np.where(by_laser, INDEPENDENT_LASER, INDEPENDENT_DEPTH)
    fit = logs[0] / max(float(weights[met].sum()), LEAST_WEIGHT)
    odds = LASER if by_laser.all() else DEPTH
    return odds.probability(min(lead, FARTHEST_LEAD * len(views)), float(fit), float(met.mean()))
