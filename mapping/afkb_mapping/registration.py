"""Places each view in the map: odometry, corrected by matching what it sees to the map so far.

Planar (x, y, yaw): height, roll and pitch stay those of the levelled odometry. Local matching
only; drift that is left after a long way round is for loop closing to mend (paper §II.E).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View
from afkb_mapping.geometry import T_from_xy_yaw, inverse
from afkb_mapping.lost import Lost
from afkb_mapping.odometry import step_covariance
from afkb_mapping.placing_record import PlacingRecord
from afkb_mapping.scan_matching import LocalMap, Match, agreement, apply_motion, rotation
from afkb_mapping.scan_surface import SurfacePoints
from afkb_mapping.seen_through import compared
from afkb_mapping.surface_map import SurfaceMap
from afkb_mapping.view_matching import GOOD_OVERLAP, best_match
from afkb_mapping.view_surface import ViewSurface, surface_in_map

Array = NDArray[np.float64]

NEW_GROUND = 0.5
"""Where this part of a view finds no surface within reach, it shows new ground, no wrong pose."""
NEAR_M = 1.0
"""... within this reach."""
UNMATCHED_VIEWS = 3
"""After this many unmatched views in a row, none of which looks through the map, odometry is
believed: what was mapped here has changed."""
IMAGES_IN_A_ROW = 2
"""So many depth images in a row must contradict the map before the robot is lost: where a tour has
few views, one by itself often does after some drift. A scan, which sees all round, needs no second.
"""
CONTRADICTED = "it looks through what is mapped where odometry has it"
RADIUS_M = 15.0
"""Map within this distance of the robot takes part in a match, whatever the sensor's range."""


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPose:
    """Where a view was taken.

    - `T_map_base`: 4x4, base in the map frame. `covariance`: (3, 3) of x, y (m), yaw (rad).
    - `matched`: what it sees fixed it; else it is odometry's. `overlap`: fraction of the view's
      surface that lies on the map's.
    """

    T_map_base: Array
    covariance: Array
    matched: bool
    overlap: float


class ScanRegistration:
    """Places views one after another; the first one defines the map frame.

    `T_map_odom` takes the source's pose frame to the map frame at the first view (levelling).
    `record` is told where the robot was lost and found again.
    """

    def __init__(self, T_map_odom: Array, record: PlacingRecord | None = None) -> None:
        self._record = record or PlacingRecord()
        self._lost = Lost()
        self._T_map_odom = T_map_odom.astype(np.float64)
        self._T_odom_base: Array | None = None
        self._covariance = np.zeros((3, 3))
        self._drift = np.zeros((3, 3))
        self._scans, self._images = SurfaceMap(), SurfaceMap()
        self._unmatched = self._contradicted = 0

    def place(self, view: View) -> PlacedPose:
        """Where the view was taken; what it sees becomes part of the map that later ones match.

        Without a laser, given camera poses (`has_base` False) are kept: they are no odometry.
        Raises `BadFrame` where it was not taken where odometry has it, nor surely anywhere else.
        """
        T_predicted = self._T_map_odom @ view.T_odom_base
        if not view.has_base and view.scan is None:
            return PlacedPose(T_predicted, np.zeros((3, 3)), False, 0.0)
        if self._T_odom_base is not None:
            self._drift = self._drift + step_covariance(self._T_odom_base, view.T_odom_base)
        self._T_odom_base = view.T_odom_base
        seen = surface_in_map(view, T_predicted)
        if seen.is_blind:
            self._lost.check(view)
            self._record.blind += 1
            return PlacedPose(T_predicted, self._covariance + self._drift, False, 0.0)
        if not len(self._map_of(seen)):
            self._take_in(seen)
            return PlacedPose(T_predicted, self._covariance + self._drift, True, 1.0)
        return self._match(view, seen, T_predicted)

    def recall(self, view: View) -> None:
        """Make what a placed view of an earlier visit shows part of the map, as it is placed."""
        assert view.T_map_base is not None
        self._take_in(surface_in_map(view, view.T_map_base))

    def _take_in(self, seen: ViewSurface) -> None:
        self._scans.add(seen.scan)
        self._images.add(seen.image)

    def _map_of(self, seen: ViewSurface) -> SurfaceMap:
        return self._scans if seen.by_laser else self._images

    def _match(self, view: View, seen: ViewSurface, T_predicted: Array) -> PlacedPose:
        pivot = T_predicted[:2, 3].copy()
        prior = self._drift + np.diag(np.square(seen.odometry_floor))
        surface = seen.surest.near(pivot, RADIUS_M)
        reach = float(np.linalg.norm(surface.points_xy - pivot, axis=1).max()) + NEAR_M
        local_map = LocalMap(self._map_of(seen).near(pivot, reach))
        match = best_match(surface, local_map, pivot, prior)
        fits = match is not None and match.overlap >= GOOD_OVERLAP
        if self._lost and fits and seen.by_laser:  # it sees all round: hardly by chance
            self._lost.end(view, self._record)
        contradicted = not fits and _contradicts(surface, match, local_map, pivot)
        self._contradicted = self._contradicted + 1 if contradicted else 0
        if self._lost or self._contradicted >= (1 if seen.by_laser else IMAGES_IN_A_ROW):
            return self._look_for_place(view, seen, T_predicted, prior)
        if contradicted:
            raise BadFrame(CONTRADICTED)
        if match is None:
            return self._go_on_by_odometry(seen, surface, local_map, T_predicted)
        self._covariance = inverse(match.information + inverse(prior))
        return self._settle(seen, match, T_predicted)

    def _settle(self, seen: ViewSurface, match: Match, T_predicted: Array) -> PlacedPose:
        """Believe a match: the view becomes part of the map, and odometry is corrected."""
        self._unmatched, self._drift = 0, np.zeros((3, 3))
        T_correction = _about(T_predicted[:2, 3], match.motion)
        self._T_map_odom = T_correction @ self._T_map_odom
        self._take_in(seen.moved(T_correction[:2, :2], T_correction[:2, 3]))
        return PlacedPose(T_correction @ T_predicted, self._covariance, True, match.overlap)

    def _look_for_place(
        self, view: View, seen: ViewSurface, T_predicted: Array, prior: Array
    ) -> PlacedPose:
        """A lost robot looks for where its last views fit the map, near odometry or anywhere."""
        surface_map = self._map_of(seen)
        match = self._lost.look(view, seen, T_predicted, prior, surface_map, self._record)
        self._covariance = inverse(match.information)
        return self._settle(seen, match, T_predicted)

    def _go_on_by_odometry(
        self, seen: ViewSurface, surface: SurfacePoints, local_map: LocalMap, T_predicted: Array
    ) -> PlacedPose:
        """Keep odometry's pose; take the view in only where it can't double a wall."""
        self._unmatched += 1
        overlap, _ = agreement(surface, local_map)
        _, found = local_map.nearest(surface, NEAR_M)
        is_new = found.mean() < 1 - NEW_GROUND or self._unmatched > UNMATCHED_VIEWS
        if is_new and not compared(surface, local_map.surface, T_predicted[:2, 3]).disagrees:
            self._take_in(seen)
        return PlacedPose(T_predicted, self._covariance + self._drift, False, overlap)


def _contradicts(
    seen: SurfacePoints, match: Match | None, local_map: LocalMap, pivot_xy: Array
) -> bool:
    """Whether what is seen contradicts the map, even where it matches best."""
    placed = seen if match is None else apply_motion(match.motion, pivot_xy, seen)
    center = pivot_xy if match is None else pivot_xy + match.motion[:2]
    comparison = compared(placed, local_map.surface, center)
    return comparison.disagrees if match is None else comparison.contradicts


def _about(pivot: Array, motion: Array) -> Array:
    """4x4 planar transform that turns about the pivot by motion[2] and shifts by motion[:2]."""
    T = T_from_xy_yaw(0.0, 0.0, float(motion[2]))
    T[:2, 3] = pivot + motion[:2] - rotation(float(motion[2])) @ pivot
    return T
