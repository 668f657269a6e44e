"""Poses that agree best with all steps and loops: a robust pose graph (paper §II.E; gtsam)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.loops.steps import Constraint, pose_of

Array = NDArray[np.float64]

CONSISTENT = 11.34
"""Squared Mahalanobis distance within which 99 % of right constraints lie (chi², 3 degrees)."""
ROBUST_SCALE = 1.0
"""Standard deviations from which on a loop counts less,"""
TAIL_SCALE = 3.0
"""and from which on a loop, in the end, or a step hardly counts."""


@dataclass(frozen=True, slots=True, eq=False)
class Loop:
    """Station `later` as seen from station `earlier`."""

    earlier: int
    later: int
    constraint: Constraint


def optimised(
    start: Sequence[Array], steps: Sequence[Constraint], loops: Sequence[Loop]
) -> list[Array]:
    """Poses (4, 4) of all stations, from `start` on; the first stays where it is.

    Steps are believed as their covariance says, heavy-tailed (Cauchy). Loops pull from afar at
    first (Cauchy); then one that contradicts the others lets go (Geman and McClure 1985).
    """
    import gtsam

    kernels = gtsam.noiseModel.mEstimator
    poses = list(start)
    for robust in (kernels.Cauchy.Create(ROBUST_SCALE), kernels.GemanMcClure.Create(TAIL_SCALE)):
        graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
        fixed = gtsam.noiseModel.Diagonal.Sigmas(np.full(3, 1e-6))
        graph.add(gtsam.PriorFactorPose2(0, gtsam.Pose2(*pose_of(poses[0])), fixed))
        for i, T in enumerate(poses):
            values.insert(i, gtsam.Pose2(*pose_of(T)))
        steady: Any = kernels.Cauchy.Create(TAIL_SCALE)
        edges = [(i, i + 1, step, steady) for i, step in enumerate(steps)]
        edges += [(loop.earlier, loop.later, loop.constraint, robust) for loop in loops]
        for a, b, constraint, kernel in edges:
            gaussian = gtsam.noiseModel.Gaussian.Covariance(constraint.covariance)
            noise = gtsam.noiseModel.Robust.Create(kernel, gaussian)
            T_a_b = gtsam.Pose2(*pose_of(constraint.T_a_b))
            graph.add(gtsam.BetweenFactorPose2(a, b, T_a_b, noise))
        found = gtsam.LevenbergMarquardtOptimizer(graph, values).optimize()
        at = [found.atPose2(i) for i in range(len(poses))]
        poses = [T_from_xy_yaw(p.x(), p.y(), p.theta()) for p in at]
    return poses


def disagreement(poses: Sequence[Array], loop: Loop) -> float:
    """Squared Mahalanobis distance of a loop from what the poses say."""
    T = np.linalg.inv(poses[loop.earlier]) @ poses[loop.later]
    off = pose_of(np.linalg.inv(loop.constraint.T_a_b) @ T)
    return float(off @ np.linalg.solve(loop.constraint.covariance, off))
