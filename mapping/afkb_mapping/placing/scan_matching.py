"""Matching one scan's surface to the map's: point-to-line ICP, and a coarse search before it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from afkb_mapping.placing.scan_surface import RANGE_SIGMA_M, SurfacePoints

Array = NDArray[np.float64]

NORMAL_WEIGHT_M = 0.2
"""Metres that a unit difference of normals counts for: keeps the two sides of a wall apart."""
LEVELS_APART_M = 10.0
"""Further than any match reaches: only points of one level correspond."""
RADII_M = (0.6, 0.3, 0.15)
"""Correspondence radius, coarse to fine; the first must span what odometry errs between views."""
STEPS_PER_RADIUS = 10
EFFECTIVE_BEAMS = 40.0
"""Beams on one wall share their errors; a scan is worth at most this many independent ones."""
ALONG_M = 0.4
"""How far along a wall the nearest mapped point may be: sparse beams hit between earlier ones."""
CLOSE_M = 0.05
"""A scan point this near a mapped surface that faces the same way counts as overlapping."""


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """Planar motion about `pivot_xy` that lays a scan on the map.

    - `motion`: (3,) dx, dy (m), dyaw (rad). `information`: (3, 3), of the scan alone.
    - `overlap`: fraction of the scan's points that lie on the map's surface after it.
    - `residual_m`: median distance of those from the surface.
    """

    motion: Array
    information: Array
    overlap: float
    residual_m: float


class LocalMap:
    """The map's surface near the robot, indexed for matching."""

    def __init__(self, surface: SurfacePoints) -> None:
        self.surface = surface
        self._tree = cKDTree(_with_normals(surface)) if len(surface) else None

    def nearest(
        self, scan: SurfacePoints, radius_m: float
    ) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
        """Index of the map point nearest to each scan point, and whether it is within radius."""
        if self._tree is None:
            return np.zeros(len(scan), dtype=np.intp), np.zeros(len(scan), dtype=bool)
        distances, indices = self._tree.query(_with_normals(scan), distance_upper_bound=radius_m)
        found = np.isfinite(distances)
        return np.where(found, indices, 0), found


def _with_normals(surface: SurfacePoints) -> Array:
    normals, level = NORMAL_WEIGHT_M * surface.normals_xy, LEVELS_APART_M * surface.level
    return np.column_stack([surface.points_xy, normals, level])


def rotation(yaw: float) -> Array:
    """The (2, 2) rotation by yaw, rad."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s], [s, c]])


def apply_motion(motion: Array, pivot_xy: Array, surface: SurfacePoints) -> SurfacePoints:
    """The surface turned about the pivot by motion[2] and shifted by motion[:2]."""
    R = rotation(motion[2])
    return surface.moved(R, pivot_xy + motion[:2] - R @ pivot_xy)


def refine(
    scan: SurfacePoints,
    local_map: LocalMap,
    pivot_xy: Array,
    start: Array,
    prior_information: Array,
    prior_mean: Array,
    radii_m: tuple[float, ...] = RADII_M,
) -> Match:
    """Point-to-line ICP from `start`, pulled towards odometry (`prior_mean`) by its information.

    The pull is weak beside a wall's; along a direction that no wall fixes (a corridor's length)
    nothing else acts, so the motion there is odometry's.
    """
    motion = start.copy()
    information = np.zeros((3, 3))
    for radius_m in radii_m:
        for _ in range(STEPS_PER_RADIUS):
            information, gradient = _normal_equations(scan, local_map, pivot_xy, motion, radius_m)
            pull = prior_information @ (prior_mean - motion)
            step = np.linalg.solve(information + prior_information, gradient + pull)
            motion = motion + step
            if abs(step[:2]).max() < 2e-4 and abs(step[2]) < 1e-4:
                break
    overlap, residual = agreement(apply_motion(motion, pivot_xy, scan), local_map)
    return Match(motion, information, overlap, residual)


def _normal_equations(
    scan: SurfacePoints, local_map: LocalMap, pivot_xy: Array, motion: Array, radius_m: float
) -> tuple[Array, Array]:
    moved = apply_motion(motion, pivot_xy, scan)
    index, found = local_map.nearest(moved, max(radius_m, ALONG_M))
    if not found.any():
        return np.zeros((3, 3)), np.zeros(3)
    surface, points = local_map.surface, moved.points_xy[found]
    normals = surface.normals_xy[index[found]]
    errors = ((surface.points_xy[index[found]] - points) * normals).sum(axis=1)
    arm = points - (pivot_xy + motion[:2])
    J = np.column_stack([normals, arm[:, 0] * normals[:, 1] - arm[:, 1] * normals[:, 0]])
    # Geman-McClure: what moved since, or was never mapped, lets go as the radius shrinks.
    scale = max(radius_m / 3, RANGE_SIGMA_M)
    weights = (scale**2 / (scale**2 + errors**2)) ** 2
    weights *= min(1.0, EFFECTIVE_BEAMS / found.sum()) / scan.sigma_m[found] ** 2
    return (J * weights[:, None]).T @ J, J.T @ (weights * errors)


def agreement(placed: SurfacePoints, local_map: LocalMap) -> tuple[float, float]:
    """Fraction of a placed scan's points that lie on the map, and their median distance, m."""
    if not len(placed):
        return 0.0, math.inf
    index, found = local_map.nearest(placed, ALONG_M)
    surface = local_map.surface
    offsets = surface.points_xy[index] - placed.points_xy if len(surface) else placed.points_xy
    distances = np.abs((offsets * placed.normals_xy).sum(axis=1))
    close = found & (distances < CLOSE_M)
    return float(close.mean()), float(np.median(distances[close])) if close.any() else math.inf
