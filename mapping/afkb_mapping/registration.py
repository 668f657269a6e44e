"""Places each view in the map: odometry, corrected by matching its laser scan to the map so far.

Planar (x, y, yaw): height, roll and pitch stay those of the levelled odometry. Local matching
only; drift that is left after a long way round is for loop closing to mend (paper §II.E).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.coarse_search import candidates
from afkb_mapping.geometry import T_from_xy_yaw, transform_xy, yaw_of
from afkb_mapping.scan_matching import LocalMap, Match, agreement, refine, rotation
from afkb_mapping.scan_surface import SurfaceMap, SurfacePoints, surface_of

Array = NDArray[np.float64]

ODOMETRY_SHIFT = 0.10
"""Standard deviation of odometry's shift, m per m travelled."""
ODOMETRY_TURN = (0.10, 0.06)
"""Standard deviation of its turn, rad per rad turned and rad per m travelled."""
ODOMETRY_FLOOR = (0.03, 0.03, 0.02)
"""What it may be off (m, m, rad) between two views however little the robot moved."""
MIN_POINTS = 20
"""A scan with fewer surface points fixes no pose: the laser is blind here."""
GOOD_OVERLAP = 0.7
"""A match near odometry that explains this part of the scan needs no second opinion; below it, the
coarse search is asked."""
LEAST_OVERLAP = 0.15
"""Where the robot enters a room little of a scan is known; this much, near odometry, will do."""
MAX_DEVIATION = 3.0
"""Standard deviations from odometry within which a match counts as near."""
JUMP_OVERLAP = 0.5
"""A match further from odometry must explain this part of the scan,"""
JUMP_GAIN = 0.15
"""and this much more of it than the best near one does."""
NEW_GROUND = 0.5
"""Where this part of a scan finds no surface within reach, it shows new ground, no wrong pose."""
REACH_M, REACH_RAD = 1.0, math.radians(30)
"""Greatest reach of the coarse search: slip and collisions within one step of a recording,"""
REACH_DEVIATIONS = 8.0
"""and its reach in standard deviations of odometry where that is less."""
LOST_VIEWS = 3
"""After this many unmatched views in a row the map starts anew at the odometry's place."""
RADIUS_M = 15.0
"""Map within this distance of the robot takes part in a match, whatever the laser's range."""


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPose:
    """Where a view was taken.

    - `T_map_base`: 4x4, base in the map frame. `covariance`: (3, 3) of x, y (m), yaw (rad).
    - `matched`: a scan fixed it; else it is odometry's. `overlap`: fraction of the scan's surface
      that lies on the map's.
    """

    T_map_base: Array
    covariance: Array
    matched: bool
    overlap: float


class ScanRegistration:
    """Places views one after another; the first one defines the map frame.

    `T_map_odom` takes the source's pose frame to the map frame at the first view (levelling).
    """

    def __init__(self, T_map_odom: Array) -> None:
        self._T_map_odom = T_map_odom.astype(np.float64)
        self._T_odom_base: Array | None = None
        self._covariance = np.zeros((3, 3))
        self._drift = np.zeros((3, 3))
        self._map = SurfaceMap()
        self._unmatched = 0

    def place(self, view: View) -> PlacedPose:
        """Where the view was taken; its scan becomes part of the map that the next ones match."""
        T_predicted = self._T_map_odom @ view.T_odom_base
        self._drift = self._drift + self._step_covariance(view.T_odom_base)
        self._T_odom_base = view.T_odom_base
        scan = _surface_in_map(view, T_predicted)
        if len(scan) < MIN_POINTS:
            return PlacedPose(T_predicted, self._covariance + self._drift, False, 0.0)
        if not len(self._map):
            self._map.add(scan)
            return PlacedPose(T_predicted, self._covariance + self._drift, True, 1.0)
        return self._match(scan, T_predicted)

    def recall(self, view: View) -> None:
        """Let the scan of a view that an earlier visit placed be part of the map."""
        assert view.T_map_base is not None
        self._map.add(_surface_in_map(view, view.T_map_base))

    def _step_covariance(self, T_odom_base: Array) -> Array:
        """(3, 3) of odometry's step since the last view."""
        if self._T_odom_base is None:
            return np.zeros((3, 3))
        T_step = np.linalg.inv(self._T_odom_base) @ T_odom_base
        length, turn = float(np.linalg.norm(T_step[:3, 3])), abs(yaw_of(T_step))
        shift = ODOMETRY_SHIFT * length
        yaw = ODOMETRY_TURN[0] * turn + ODOMETRY_TURN[1] * length
        return np.diag([shift**2, shift**2, yaw**2])

    def _match(self, scan: SurfacePoints, T_predicted: Array) -> PlacedPose:
        pivot = T_predicted[:2, 3].copy()
        prior = self._drift + np.diag(np.square(ODOMETRY_FLOOR))
        local_map = LocalMap(self._map.near(pivot, RADIUS_M))
        match = self._best_match(scan.near(pivot, RADIUS_M), local_map, pivot, prior)
        if match is None:
            return self._go_on_by_odometry(scan, local_map, T_predicted)
        self._unmatched, self._drift = 0, np.zeros((3, 3))
        self._covariance = _inverse(match.information + _inverse(prior))
        T_correction = _about(pivot, match.motion)
        self._T_map_odom = T_correction @ self._T_map_odom
        self._map.add(scan.moved(T_correction[:2, :2], T_correction[:2, 3]))
        return PlacedPose(T_correction @ T_predicted, self._covariance, True, match.overlap)

    def _best_match(
        self, scan: SurfacePoints, local_map: LocalMap, pivot: Array, prior: Array
    ) -> Match | None:
        """The match from odometry's pose; where that explains little, the coarse search's best."""
        if len(scan) < MIN_POINTS:
            return None
        nowhere = np.zeros(3)
        match = refine(scan, local_map, pivot, nowhere, _inverse(prior), nowhere)
        near = _deviation(match, prior) <= MAX_DEVIATION
        if near and match.overlap >= GOOD_OVERLAP:
            return match
        staying = match.overlap if near else agreement(scan, local_map)[0]
        jump = max([match, *_jumps(scan, local_map, pivot, prior)], key=lambda m: m.overlap)
        if jump.overlap >= max(JUMP_OVERLAP, staying + JUMP_GAIN):
            return jump
        return match if near and match.overlap >= LEAST_OVERLAP else None

    def _go_on_by_odometry(
        self, scan: SurfacePoints, local_map: LocalMap, T_predicted: Array
    ) -> PlacedPose:
        """Keep odometry's pose; take the scan in only where it can't double a wall, or if lost."""
        self._unmatched += 1
        overlap, _ = agreement(scan, local_map)
        _, found = local_map.nearest(scan, REACH_M)
        if found.mean() < 1 - NEW_GROUND or self._unmatched > LOST_VIEWS:
            self._map.add(scan)
        return PlacedPose(T_predicted, self._covariance + self._drift, False, overlap)


def _jumps(scan: SurfacePoints, local_map: LocalMap, pivot: Array, prior: Array) -> list[Match]:
    """Matches from wherever the coarse search finds the scan to fit."""
    if not len(local_map.surface):
        return []
    sigmas = np.sqrt(np.diag(prior))
    reach = np.minimum(REACH_DEVIATIONS * sigmas, [REACH_M, REACH_M, REACH_RAD])
    map_points = local_map.surface.points_xy
    starts = candidates(scan, map_points, pivot, float(reach[:2].max()), float(reach[2]), sigmas)
    loose = np.diag(1 / reach**2)
    return [refine(scan, local_map, pivot, start, loose, start, (0.3, 0.15)) for start in starts]


def _deviation(match: Match, prior: Array) -> float:
    """Mahalanobis distance of a match from odometry."""
    return math.sqrt(float(match.motion @ _inverse(prior) @ match.motion))


def _inverse(matrix: Array) -> Array:
    inverse: Array = np.linalg.inv(matrix).astype(np.float64)
    return inverse


def _surface_in_map(view: View, T_map_base: Array) -> SurfacePoints:
    """The scan's surface, seen from above, were the base there; empty without a scan."""
    if view.scan is None or view.T_base_laser is None:
        return SurfacePoints(np.empty((0, 2)), np.empty((0, 2)))
    surface = surface_of(view.scan)
    T_map_laser = T_map_base @ view.T_base_laser
    normals = surface.normals_xy @ T_map_laser[:2, :2].T
    return SurfacePoints(transform_xy(T_map_laser, surface.points_xy), normals)


def _about(pivot: Array, motion: Array) -> Array:
    """4x4 planar transform that turns about the pivot by motion[2] and shifts by motion[:2]."""
    T = T_from_xy_yaw(0.0, 0.0, float(motion[2]))
    T[:2, 3] = pivot + motion[:2] - rotation(float(motion[2])) @ pivot
    return T
