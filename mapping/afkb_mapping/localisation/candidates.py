"""Poses that a robot may have, and which of them are one."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

APART_M, APART_RAD = 0.4, math.radians(15)
"""Candidates nearer to each other than both of these are one."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A pose of the base in the map frame (m, rad) and the log-likelihood of all readings there."""

    x: float
    y: float
    yaw: float
    log_likelihood: float

    @property
    def pose(self) -> NDArray[np.float64]:
        """(3,): x, y, yaw."""
        return np.array([self.x, self.y, self.yaw])

    def is_near(self, other: Candidate) -> bool:
        """Whether both are one place and heading."""
        turn = abs(math.remainder(self.yaw - other.yaw, math.tau))
        return math.hypot(self.x - other.x, self.y - other.y) < APART_M and turn < APART_RAD


def best_apart(candidates: Iterable[Candidate], most: int) -> list[Candidate]:
    """The likeliest, best first, of which none is near a better one."""
    kept: list[Candidate] = []
    for candidate in sorted(candidates, key=lambda c: -c.log_likelihood):
        if not any(candidate.is_near(better) for better in kept):
            kept.append(candidate)
            if len(kept) == most:
                break
    return kept


def peaks_of(
    scores: NDArray[np.float32], places_xy: NDArray[np.float64], most: int
) -> list[Candidate]:
    """The highest scores (P, turns) at places (P, 2), m; none near a higher one."""
    left = scores.copy()
    turns = scores.shape[1]
    beside = math.floor(APART_RAD / math.tau * turns)
    peaks = []
    for _ in range(most):
        which, turn = divmod(int(np.argmax(left)), turns)
        if not np.isfinite(left[which, turn]):
            break
        x, y = places_xy[which]
        yaw = turn * math.tau / turns
        peaks.append(Candidate(float(x), float(y), yaw, float(left[which, turn])))
        near = np.flatnonzero(np.hypot(*(places_xy - places_xy[which]).T) < APART_M)
        around = (turn + np.arange(-beside, beside + 1)) % turns
        left[np.ix_(near, around)] = -np.inf
    return peaks
