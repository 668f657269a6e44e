"""Every place and heading of a map, scored against what was read; the best, then made exact."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.localisation.expectation import CELL_M, Expectation
from afkb_mapping.localisation.readings import BEARINGS, Readings, joined
from afkb_mapping.localisation.search_kernels import BEARING_STEP, at_poses, scores_of
from afkb_mapping.localisation.sensor_model import STEP_M, STEPS, log_likelihoods

Array = NDArray[np.float64]

APART_M, APART_RAD = 0.4, math.radians(15)
"""Candidates nearer to each other than both of these are one."""
COARSE_SIGMA_M = 0.2
"""Places are first tried this far apart."""
PLACE_STEP = 2
"""... in every second cell, with every other reading."""
TRIED, CANDIDATES = 60, 12
"""So many of the first round are looked at closely, and so many of those are made exact."""
CLOSER = ((0.1, 2.0), (0.05, 1.0))
EXACT = ((0.02, 0.5), (0.01, 0.25))
"""Steps (m, degrees) in which a candidate climbs to its peak."""
MOST_STEPS = 6
ODOMETRY_SIGMAS = (0.05, 0.05, math.radians(2.0))
"""By how much (m, m, rad) odometry errs between views that are asked together: two per cent of a
turn of 90°, a few of a step."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A pose of the base in the map frame (m, rad) and the log-likelihood of all readings there."""

    x: float
    y: float
    yaw: float
    log_likelihood: float

    def is_near(self, other: Candidate) -> bool:
        """Whether both are one place and heading."""
        turn = abs((self.yaw - other.yaw + math.pi) % (2 * math.pi) - math.pi)
        return math.hypot(self.x - other.x, self.y - other.y) < APART_M and turn < APART_RAD


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """A map as a search looks at it; tables of `log_likelihoods`, coarse and fine."""

    expectation: Expectation
    coarse: NDArray[np.float32]
    fine: NDArray[np.float32]

    @classmethod
    def of(cls, expectation: Expectation) -> Search:
        """The search in a map that lets expect this."""
        return cls(expectation, log_likelihoods(COARSE_SIGMA_M), log_likelihoods())

    def candidates(self, views: Sequence[Readings]) -> list[Candidate]:
        """The likeliest poses of the last view's base, best first, none near a better one.

        `views`: what each has read, in the frame of that base by odometry. No pose where nothing
        was read.
        """
        readings = joined(views)
        if not len(readings) or not len(self.expectation.places):
            return []
        near = [self._climbed(c, readings, CLOSER) for c in self._first_round(readings)]
        best = _apart(sorted(near, key=lambda c: -c.log_likelihood), CANDIDATES)
        exact = [self._climbed(c, readings, EXACT) for c in best]
        if len(views) > 1:
            exact = [self._relaxed(c, views) for c in exact]
        return _apart(sorted(exact, key=lambda c: -c.log_likelihood), CANDIDATES)

    def _first_round(self, readings: Readings) -> list[Candidate]:
        known = self.expectation
        tried = np.flatnonzero((known.places % PLACE_STEP == 0).all(axis=1))
        some = np.arange(0, len(readings), 2 if len(readings) > BEARINGS // 6 else 1)
        scores = scores_of(
            tried,
            known.places,
            known.index,
            known.steps,
            readings.origins_xy,
            readings.origin[some],
            np.floor(readings.bearing[some] / (2 * math.pi) * BEARINGS).astype(np.int64) % BEARINGS,
            _in_steps(readings.range_m[some]),
            readings.band[some],
            readings.kind[some],
            self.coarse,
        )
        flat = scores.ravel()
        most = min(TRIED * BEARINGS, flat.size)
        best = np.argpartition(-flat, most - 1)[:most]
        best = best[np.lexsort((best, -flat[best]))]
        return _apart((self._place(n, tried, scores) for n in best.tolist()), TRIED)

    def _place(
        self, number: int, tried: NDArray[np.intp], scores: NDArray[np.float32]
    ) -> Candidate:
        which, turn = divmod(number, scores.shape[1])
        row, col = self.expectation.places[tried[which]]
        x, y = self.expectation.origin_xy + (np.array([col, row]) + 0.5) * CELL_M
        yaw = turn * BEARING_STEP * 2 * math.pi / BEARINGS
        return Candidate(float(x), float(y), yaw, float(scores[which, turn]))

    def _relaxed(self, start: Candidate, views: Sequence[Readings]) -> Candidate:
        """Each view where it fits best, as far as odometry errs; the pose of the last."""
        found = [self._climbed(start, view, CLOSER[1:] + EXACT[:1], True) for view in views]
        return replace(found[-1], log_likelihood=sum(c.log_likelihood for c in found))

    def _climbed(
        self,
        start: Candidate,
        readings: Readings,
        rounds: tuple[tuple[float, float], ...],
        is_held: bool = False,
    ) -> Candidate:
        """The highest likelihood near a candidate; held near it by odometry, or not."""
        first = np.array([start.x, start.y, start.yaw])
        pose, best = first, -math.inf
        for step_m, step_deg in rounds:
            steps = np.array([step_m, step_m, math.radians(step_deg)])
            for _ in range(MOST_STEPS):
                around = pose + _AROUND * steps
                found = self.log_likelihood_at(around, readings)
                if is_held:
                    found -= 0.5 * np.square((around - first) / ODOMETRY_SIGMAS).sum(axis=1)
                top = int(np.argmax(found))
                best, pose = float(found[top]), around[top]
                if top == len(_AROUND) // 2:
                    break
        yaw = math.atan2(math.sin(pose[2]), math.cos(pose[2]))
        return Candidate(float(pose[0]), float(pose[1]), yaw, best)

    def log_likelihood_at(self, poses: Array, readings: Readings) -> Array:
        """(N,) summed log-likelihood with the base at poses (N, 3): x, y (m), yaw (rad)."""
        return at_poses(
            poses - np.array([*self.expectation.origin_xy, 0.0]),
            self.expectation.distance_m,
            readings.origins_xy,
            readings.origin,
            readings.bearing,
            _in_steps(readings.range_m),
            readings.band,
            readings.kind,
            self.fine,
        )


_AROUND = np.array([[i, j, k] for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)])


def _in_steps(range_m: Array) -> NDArray[np.int64]:
    return np.clip(np.round(range_m / STEP_M), 0, STEPS - 1).astype(np.int64)


def _apart(ranked: Iterable[Candidate], most: int) -> list[Candidate]:
    """The first ones of which none is near an earlier one."""
    kept: list[Candidate] = []
    for candidate in ranked:
        if not any(candidate.is_near(better) for better in kept):
            kept.append(candidate)
            if len(kept) == most:
                break
    return kept
