"""Where something is that was not seen yet: a distribution over points of the floor plane.

A region in the sense of a Bayes filter over places (Thrun, Burgard and Fox, Probabilistic Robotics,
ch. 2 and 4): what a relation says of each point, times what looks have said of it since.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.inference.existence import EMPTY_LIKELIHOOD_RATIO, OVERLOOKED_LIKELIHOOD_RATIO
from afkb_mapping.things.visibility import Sight

Array = NDArray[np.float64]

DIRECTIONS = 16
RINGS = (-1.0, 0.0, 1.0)
"""Distances at which a ring is sampled, in standard deviations from its mean."""
MOST_ALONG = 8
"""Points of a rectangle along its longer side, so that a distribution stays small."""
FINEST_M = 0.10
LOOKED_FOR_WITHIN_M = 2.0
"""Up to here a cup would be found: at twice that, its 9 cm are a dozen pixels of 640."""
UNDER_TOPS = (1 / 3, 2 / 3)
"""Lowest and highest top of what carries a thing: the more of a foot would have to be hidden, the
less probable, down to nothing (a triangular density's thirds)."""
TELLING = 1e-3
"""A look that changes the odds by less is none."""


@dataclass(slots=True, eq=False)
class Whereabouts:
    """Points (N, 2), map frame, m, each the middle of a square of `step_m`.

    - `density` (N,): what the relation says of each, not normalised; 0 where it can't be, as beyond
      walls. That speaks for the places that are left: a chair by a wall has its table elsewhere.
    - `unseen` (N,): how much of a thing there would have been missed so far. `told` (N, 2): the
      same of looks since, at the lowest and at the highest top that the thing may have, which are
      as probable as `of_tops` says.
    """

    points_xy: Array
    density: Array
    step_m: float
    unseen: Array
    told: Array
    of_tops: tuple[float, float] = (0.5, 0.5)

    @classmethod
    def _of(cls, points_xy: Array, density: Array, step_m: float) -> Whereabouts:
        n = len(points_xy)
        return cls(points_xy, density, step_m, np.ones(n), np.ones((n, 2)))

    @classmethod
    def even(cls, low_xy: Array, high_xy: Array) -> Whereabouts:
        """Anywhere in a rectangle, m, under or on things."""
        step = max(FINEST_M, float((high_xy - low_xy).max()) / MOST_ALONG)
        axes = [
            lo + (np.arange(n) + 0.5) * (hi - lo) / n
            for lo, hi in zip(low_xy, high_xy, strict=True)
            for n in [max(1, round(float(hi - lo) / step))]
        ]
        points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
        found = cls._of(points, np.ones(len(points)), step)
        found.of_tops = UNDER_TOPS
        return found

    @classmethod
    def around(cls, middle_xy: Array, distance_m: tuple[float, float]) -> Whereabouts:
        """About a point (2,), at a distance of that mean and standard deviation, m."""
        mean, sd = distance_m
        radii = np.maximum(mean + np.array(RINGS) * sd, FINEST_M)
        angles = np.arange(DIRECTIONS) * 2 * np.pi / DIRECTIONS
        headings = np.column_stack([np.cos(angles), np.sin(angles)])
        points = (middle_xy + radii[:, None, None] * headings).reshape(-1, 2)
        weights = np.repeat(np.exp(-0.5 * np.square(RINGS)), DIRECTIONS)
        step = float(np.sqrt(np.pi * (radii[-1] ** 2 - max(radii[0] - sd, 0) ** 2) / len(points)))
        return cls._of(points, weights, max(step, FINEST_M))

    @property
    def _weights(self) -> Array:
        weights: Array = self.density * self.unseen * (self.told @ self.of_tops)
        return weights

    @property
    def shares(self) -> Array:
        """(N,) probability of each point if the thing is there at all; they sum to 1."""
        total = float(self._weights.sum())
        return self._weights / total if total > 0 else np.full(len(self.unseen), 1 / len(self.told))

    @property
    def open_share(self) -> float:
        """Probability (0..1) that it has not been seen yet, were it there; 0 if it can't be."""
        possible = float(self.density.sum())
        return float(self._weights.sum()) / possible if possible > 0 else 0.0

    @property
    def low_xy(self) -> Array:
        """Lower corner (2,) of what has a share, m."""
        low: Array = self.points_xy[self.density > 0].min(axis=0) - self.step_m / 2
        return low

    @property
    def high_xy(self) -> Array:
        """Upper corner (2,), m."""
        high: Array = self.points_xy[self.density > 0].max(axis=0) + self.step_m / 2
        return high

    def best_xy(self) -> Array:
        """The likeliest point (2,), m."""
        return np.array(self.points_xy[int(np.argmax(self.shares))])

    def look(self, sight: Sight, tops_m: tuple[float, float]) -> float:
        """Take in a look; returns its likelihood ratio, thing there : thing gone.

        A point that is seen through at a height counts once, whatever sees through it again: looks
        that err, for a pose or a see-through thing, mostly err together.
        """
        before = self.open_share
        for column, top in enumerate(tops_m):
            through = sight.sees_through(self.points_xy, top)
            told = np.minimum(self.told[:, column], EMPTY_LIKELIHOOD_RATIO)
            self.told[:, column] = np.where(through, told, self.told[:, column])
        return self.open_share / before

    def in_clear_view(self, sight: Sight, tops_m: tuple[float, float]) -> NDArray[np.bool_]:
        """(N,) whether a look, near enough to find small things, shows what is at each point."""
        looks = [sight.meets(self.points_xy, top, LOOKED_FOR_WITHIN_M) for top in tops_m]
        seen: NDArray[np.bool_] = np.logical_or(*looks)
        return seen

    def overlook(self, points: NDArray[np.bool_]) -> float:
        """Take in that nothing was detected at some points (N,); returns the likelihood ratio."""
        before = self.open_share
        self.told[points] *= OVERLOOKED_LIKELIHOOD_RATIO
        return self.open_share / before

    def rule_out(self, ruled_out: NDArray[np.bool_]) -> float:
        """Take in that it can't be at some points (N,); returns the likelihood ratio.

        It is above 1 where what is left has been seen less.
        """
        before = self.open_share
        if not (self.density[~ruled_out] > 0).any():
            return 0.0
        self.density = np.where(ruled_out, 0.0, self.density)
        return self.open_share / before

    def forget_looks(self) -> None:
        """Let looks be evidence again: time has passed."""
        self.told = np.ones_like(self.told)

    def takes_looks_of(self, other: Whereabouts) -> None:
        """Keep what looks said of another distribution, at the nearest of its points."""
        apart = np.linalg.norm(self.points_xy[:, None] - other.points_xy[None], axis=2)
        nearest = apart.argmin(axis=1)
        told = other.told[nearest]
        self.told = np.where((apart.min(axis=1) <= other.step_m)[:, None], told, 1.0)
