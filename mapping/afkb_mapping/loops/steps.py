"""From one station to the next: what odometry and the sensors say, and how sure they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import T_from_xy_yaw, yaw_of
from afkb_mapping.loops.stations import Station
from afkb_mapping.placing.odometry import step_covariance
from afkb_mapping.placing.scan_matching import LocalMap, refine, rotation
from afkb_mapping.placing.scan_surface import SurfacePoints

Array = NDArray[np.float64]

ODOMETRY_FAILS = 3.0
"""Where registration contradicts odometry by more standard deviations, odometry slipped."""
REGISTERED_SIGMAS = (0.05, 0.05, 0.03)
"""How sure registration's step is (m, m, rad) where odometry is not to be believed."""
STEP_OVERLAP = 0.5
"""Share of a scan that must lie on the last one's surface for the two to fix the step."""
LASER_SIGMAS = (0.005, 0.005, 0.002)
"""No match of two scans is surer than this (m, m, rad): they share the laser's own errors."""
DEPTH_SIGMAS = (0.03, 0.03, 0.01)
"""... nor one of what depth cameras see: noise at 4 m, and edges that look different from aside."""
LEAST_POINTS = 20


@dataclass(frozen=True, slots=True, eq=False)
class Constraint:
    """A relative pose: T_a_b (4x4, planar) with covariance (3, 3) of x, y (m), yaw (rad), in b."""

    T_a_b: Array
    covariance: Array


def step_between(before: Station, after: Station) -> Constraint:
    """One step of the robot, as registration placed the two views, as sure as odometry is.

    Registration follows odometry, unless that slipped.
    """
    by_odometry = np.linalg.inv(before.T_odom_base) @ after.T_odom_base
    registered = np.linalg.inv(before.T_map_base) @ after.T_map_base
    covariance = step_covariance(before.T_odom_base, after.T_odom_base)
    covariance += np.diag(np.square(LASER_SIGMAS))
    off = pose_of(np.linalg.inv(by_odometry) @ registered)
    if off @ np.linalg.solve(covariance, off) > ODOMETRY_FAILS**2:
        covariance = np.diag(np.square(REGISTERED_SIGMAS))
    return Constraint(registered, covariance)


def matched_step(before: Station, after: Station) -> Constraint:
    """The same step, and the match of the two laser scans where they overlap."""
    step = step_between(before, after)
    if not (before.has_laser and after.has_laser):
        return step
    matched = laid_on(after.surface, before.surface, step.T_a_b, STEP_OVERLAP, LASER_SIGMAS)
    return step if matched is None else fused(step, matched[0])


def laid_on(
    scan: SurfacePoints,
    onto: SurfacePoints,
    T_start: Array,
    least_overlap: float,
    sigmas: tuple[float, float, float],
) -> tuple[Constraint, float] | None:
    """Where a scan lies on a surface, both in base frames, and the overlap; None where it doesn't.

    `sigmas`: what the match can be off by at least, m, m, rad.
    """
    if len(scan) < LEAST_POINTS or len(onto) < LEAST_POINTS:
        return None
    placed = scan.moved(T_start[:2, :2], T_start[:2, 3])
    pivot = T_start[:2, 3].copy()
    loose = np.diag(1 / np.square([0.5, 0.5, 0.2]))
    match = refine(placed, LocalMap(onto), pivot, np.zeros(3), loose, np.zeros(3), (0.3, 0.15))
    if match.overlap < least_overlap:
        return None
    T = about(pivot, match.motion) @ T_start
    turn = np.eye(3)
    turn[:2, :2] = T[:2, :2]
    information = turn.T @ match.information @ turn + 1e-3 * np.eye(3)
    constraint = Constraint(T, np.linalg.inv(information) + np.diag(np.square(sigmas)))
    return constraint, match.overlap


def fused(first: Constraint, second: Constraint) -> Constraint:
    """Both of one relative pose, by their inverse covariances."""
    a, b = np.linalg.inv(first.covariance), np.linalg.inv(second.covariance)
    covariance = np.linalg.inv(a + b)
    off = pose_of(np.linalg.inv(second.T_a_b) @ first.T_a_b)
    return Constraint(second.T_a_b @ T_from_xy_yaw(*(covariance @ a @ off)), covariance)


def about(pivot: Array, motion: Array) -> Array:
    """4x4 planar transform that turns about the pivot by motion[2] and shifts by motion[:2]."""
    T = T_from_xy_yaw(0.0, 0.0, float(motion[2]))
    T[:2, 3] = pivot + motion[:2] - rotation(float(motion[2])) @ pivot
    return T


def pose_of(T: Array) -> Array:
    """(3,) x, y, yaw of a planar transform."""
    return np.array([T[0, 3], T[1, 3], yaw_of(T)])
