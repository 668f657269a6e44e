"""The robot's way as a chain of steps."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import inverse, yaw_of
from afkb_mapping.loops.steps import Constraint

Array = NDArray[np.float64]


class Way:
    """The robot's way as a chain of steps: how far it went, and how uncertain any part of it is."""

    def __init__(self, T_first: Array, steps: Sequence[Constraint]) -> None:
        T = np.eye(4)
        lengths, turns, sums = [0.0], [0.0], [np.zeros((3, 3))]
        for step in steps:
            T = T @ step.T_a_b
            lengths.append(lengths[-1] + float(np.hypot(*step.T_a_b[:2, 3])))
            turns.append(turns[-1] + abs(yaw_of(step.T_a_b)))
            adjoint = _adjoint(T)
            sums.append(sums[-1] + adjoint @ step.covariance @ adjoint.T)
        self.metres, self.turned = np.array(lengths), np.array(turns)
        self._sums = sums
        self.T = chained(T_first, steps)

    def covariance(self, a: int, b: int) -> Array:
        """(3, 3) of the pose of station b as seen from station a, a < b, in b's frame.

        First order: each step's error is carried to the end (Smith and Cheeseman 1986).
        """
        back = _adjoint(inverse(self.T[b]) @ self.T[0])
        covariance: Array = back @ (self._sums[b] - self._sums[a]) @ back.T
        return covariance


def chained(T_first: Array, steps: Sequence[Constraint]) -> list[Array]:
    """Poses from the first on, step by step."""
    poses = [T_first]
    for step in steps:
        poses.append(poses[-1] @ step.T_a_b)
    return poses


def _adjoint(T: Array) -> Array:
    """Of a planar pose: takes small motions of its frame to small motions of the other."""
    c, s = math.cos(yaw_of(T)), math.sin(yaw_of(T))
    return np.array([[c, -s, T[1, 3]], [s, c, -T[0, 3]], [0.0, 0.0, 1.0]])
