"""Self-localisation in a stored map: a pose with its probability and covariance, or lost."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.localisation.bands import HeightBands
from afkb_mapping.localisation.candidates import Candidate
from afkb_mapping.localisation.expectation import surroundings_of
from afkb_mapping.localisation.readings import Readings
from afkb_mapping.localisation.search import Search
from afkb_mapping.localisation.sensor_model import (
    HIT,
    INDEPENDENT_DEPTH,
    INDEPENDENT_LASER,
    LASER_ROW,
)

Array = NDArray[np.float64]

ELSEWHERE_LASER, ELSEWHERE_DEPTH = -1.3, -0.75
"""Mean log-likelihood of a hit at the likeliest pose in a home that is not in the map, of a laser
and of depth; measured in two homes, each asked in the other's map and, for what it costs, in its
own and in that of a later visit. A laser's is so low that most of its beams may be blind: its
readings all around fit one pose so much better than all others that this alone tells."""
SURE = 0.9
"""Below this probability the robot is lost."""
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
        probability = _probability(found, sum(_elsewhere(view) for view in views))
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


def _elsewhere(readings: Readings) -> float:
    """Log-likelihood of what was read, if it was read in a place that the map doesn't hold."""
    hits = readings.row[readings.kind == HIT]
    laser = int((hits == LASER_ROW).sum())
    depth = len(hits) - laser
    return ELSEWHERE_LASER * INDEPENDENT_LASER * laser + ELSEWHERE_DEPTH * INDEPENDENT_DEPTH * depth


def _probability(found: Sequence[Candidate], elsewhere: float) -> float:
    """Of the best candidate among the others, and a place that isn't in the map."""
    logs = np.array([*(c.log_likelihood for c in found), elsewhere])
    weights = np.exp(logs - logs.max())
    return float(weights[0] / weights.sum())
