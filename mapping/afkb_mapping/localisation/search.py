"""Every place and heading of a map, scored against what was read; the best, then made exact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.localisation.candidates import Candidate, best_apart, peaks_of
from afkb_mapping.localisation.expectation import PLACE_M, TURNS, Expectation, Surroundings
from afkb_mapping.localisation.readings import Readings, joined
from afkb_mapping.localisation.search_kernels import at_poses, scores_of
from afkb_mapping.localisation.sensor_model import (
    INDEPENDENT_DEPTH,
    LASER_ROW,
    STEP_M,
    STEPS,
    UNSEEN,
    log_likelihoods,
)

Array = NDArray[np.float64]

COARSE_SIGMA_M = 0.2
"""Places are first tried this far apart."""
PLACE_STEP = 2
"""... in every second cell."""
OFF_MAP = -1.5
"""Log-likelihood of each reading of a sensor that would stand in something."""
FIRST_READINGS, CLOSER_READINGS, EXACT_READINGS = 150, 100, 400
"""So many readings of a question tell in each round, the more the fewer candidates are left."""
TRIED, CANDIDATES = 60, 12
"""So many of the first round are looked at closely, and so many of those are made exact."""
CLOSER = ((0.1, 5.0),)
EXACT = ((0.1, 2.5), (0.05, 2.5), (0.02, 1.0), (0.01, 0.3))
HELD = ((0.05, 2.5), (0.02, 1.0))
"""Steps (m, degrees) in which a candidate climbs to its peak: both move what is 1 m off alike, so
that it may circle what it looks at; short steps go along the axes only. `HELD`: by odometry."""
SHORT_M = 0.05
MOST_STEPS = 10
EYE_STEP_M = 0.05
"""Cameras whose heights differ by less expect the same."""
MOST_EYES = 4
"""Heights of cameras for which expectations are kept."""


@dataclass(slots=True, eq=False)
class _Eyes:
    """What a camera at one height expects; tables of `log_likelihoods`, coarse and fine."""

    expectation: Expectation
    coarse: NDArray[np.float32]
    fine: NDArray[np.float32]


class Search:
    """A map as a search looks at it."""

    def __init__(self, around: Surroundings) -> None:
        self._around = around
        self._eyes: dict[int, _Eyes] = {}
        places = around.places[around.stand]
        self._tried = around.stand[(places % PLACE_STEP == 0).all(axis=1)]

    def candidates(self, views: Sequence[Readings]) -> list[Candidate]:
        """The likeliest poses of the last view's base, best first, none near a better one.

        `views`: what each has read, in the frame of that base by odometry. No pose where nothing
        was read.
        """
        readings = joined(views)
        if not len(readings) or not len(self._tried):
            return []
        some = readings.every(math.ceil(len(readings) / CLOSER_READINGS))
        near = [self._climbed(c, some, CLOSER) for c in self._first_round(readings)]
        most = readings.every(math.ceil(len(readings) / EXACT_READINGS))
        exact = [self._climbed(c, most, EXACT) for c in best_apart(near, CANDIDATES)]
        if len(views) > 1:
            exact = [self._relaxed(c, views) for c in exact]
        else:
            values = self.log_likelihood_at(np.array([c.pose for c in exact]), readings)
            exact = [
                replace(c, log_likelihood=v) for c, v in zip(exact, values.tolist(), strict=True)
            ]
        return best_apart(exact, CANDIDATES)

    def _eyes_of(self, readings: Readings) -> _Eyes:
        seen = readings.origin[readings.row != LASER_ROW]
        eye_m = float(readings.origins_xyz[seen[0], 2]) if len(seen) else 0.0
        step = round(eye_m / EYE_STEP_M)
        if step not in self._eyes:
            if len(self._eyes) == MOST_EYES:
                self._eyes.pop(next(iter(self._eyes)))
            height = step * EYE_STEP_M
            self._eyes[step] = _Eyes(
                Expectation(self._around, height),
                log_likelihoods(height, COARSE_SIGMA_M),
                log_likelihoods(height),
            )
        return self._eyes[step]

    def _first_round(self, readings: Readings) -> list[Candidate]:
        eyes = self._eyes_of(readings)
        eyes.expectation.know(readings.row)
        some = readings.every(math.ceil(len(readings) / FIRST_READINGS))
        scores = scores_of(
            self._tried,
            self._around.places,
            self._around.index,
            eyes.expectation.steps,
            some.origins_xyz,
            some.origin,
            np.floor(some.bearing / math.tau * TURNS).astype(np.int64) % TURNS,
            some.row,
            _lines(some, eyes.coarse),
            OFF_MAP * INDEPENDENT_DEPTH,
        )
        rows_cols = self._around.places[self._tried]
        places_xy = self._around.origin_xy + (rows_cols[:, ::-1] + 0.5) * PLACE_M
        return peaks_of(scores, places_xy, TRIED)

    def _relaxed(self, start: Candidate, views: Sequence[Readings]) -> Candidate:
        """Each view where it fits best, as far as odometry errs; the pose of the last."""
        found = [self._climbed(start, view, HELD, is_held=True) for view in views]
        return replace(found[-1], log_likelihood=sum(c.log_likelihood for c in found))

    def _climbed(
        self,
        start: Candidate,
        readings: Readings,
        rounds: tuple[tuple[float, float], ...],
        is_held: bool = False,
    ) -> Candidate:
        """The highest likelihood near a candidate; held near it by odometry, or not."""
        pose, best = start.pose, -math.inf
        lines = _lines(readings, self._eyes_of(readings).fine)
        for step_m, step_deg in rounds:
            steps = np.array([step_m, step_m, math.radians(step_deg)])
            for _ in range(MOST_STEPS):
                around = pose + (_AROUND if step_m >= SHORT_M else _ALONG_AXES) * steps
                found = self._at(around, readings, lines)
                if is_held:
                    off = (around - start.pose) / readings.sigmas
                    found -= 0.5 * np.square(off).sum(axis=1)
                top = int(np.argmax(found))
                best, pose = float(found[top]), around[top]
                if top == 0:
                    break
        return Candidate(
            float(pose[0]), float(pose[1]), math.remainder(float(pose[2]), math.tau), best
        )

    def log_likelihood_at(self, poses: Array, readings: Readings) -> Array:
        """(N,) summed log-likelihood with the base at poses (N, 3): x, y (m), yaw (rad)."""
        return self._at(poses, readings, _lines(readings, self._eyes_of(readings).fine))

    def _at(self, poses: Array, readings: Readings, lines: NDArray[np.float32]) -> Array:
        return at_poses(
            poses - np.array([*self._around.origin_xy, 0.0]),
            self._around.at_laser,
            self._around.in_space,
            self._around.unseen,
            readings.origins_xyz,
            readings.origin,
            readings.rays(),
            readings.range_m,
            readings.row,
            lines,
            INDEPENDENT_DEPTH * math.log(UNSEEN),
        )


_AROUND = np.array([[i, j, k] for i in (0, -1, 1) for j in (0, -1, 1) for k in (0, -1, 1)])
_ALONG_AXES = np.vstack([np.zeros(3), np.eye(3), -np.eye(3)])


def _lines(readings: Readings, table: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N, STEPS): log-likelihood of each reading, by what is expected."""
    read = np.clip(np.round(readings.range_m / STEP_M), 0, STEPS - 1).astype(np.int64)
    return table[readings.row, readings.kind, read]
