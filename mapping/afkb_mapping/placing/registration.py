"""Places each view in the map: odometry, corrected by matching what it sees to the map so far.

Planar (x, y, yaw): height, roll and pitch stay those of the levelled odometry. Local matching
only; drift that is left after a long way round is for loop closing to mend (paper §II.E).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View
from afkb_mapping.geometry import inverse
from afkb_mapping.placing.held_views import HeldViews
from afkb_mapping.placing.lost import WHY, Lost
from afkb_mapping.placing.map_so_far import MapSoFar
from afkb_mapping.placing.odometry import step_covariance
from afkb_mapping.placing.placed_pose import PlacedPose, about
from afkb_mapping.placing.probation import Probation
from afkb_mapping.placing.record import PlacingRecord
from afkb_mapping.placing.scan_matching import LocalMap, Match, agreement, apply_motion
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.seen_through import NOT_COMPARED, Comparison, compared
from afkb_mapping.placing.view_matching import GOOD_OVERLAP, MAX_DEVIATION, best_match, deviation
from afkb_mapping.placing.view_surface import ViewSurface, surface_in_map

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
        self._map = MapSoFar()
        self._unmatched = self._contradicted = 0
        self._probation: Probation | None = None

    @property
    def held(self) -> HeldViews:
        """Views that were placed by their image and may yet turn out to have been elsewhere."""
        return self._map.held

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
            if self._lost or self._probation:
                raise BadFrame(WHY)
            self._record.blind += 1
            self._map.keep_waiting(view)
            return PlacedPose(T_predicted, self._covariance + self._drift, False, 0.0)
        if not len(self._map.of(seen)):
            self._map.settle(seen)
            return PlacedPose(T_predicted, self._covariance + self._drift, True, 1.0)
        return self._match(view, seen, T_predicted)

    def recall(self, view: View) -> None:
        """Make what a placed view of an earlier visit shows part of the map, as it is placed."""
        assert view.T_map_base is not None
        self._map.settle(surface_in_map(view, view.T_map_base))

    def end(self) -> None:
        """No more views come: those whose place has not become sure by now are taken back."""
        if self._probation:
            self._record.withdraw(len(self.held.withdraw()))
        self.held.release()

    def _match(self, view: View, seen: ViewSurface, T_predicted: Array) -> PlacedPose:
        pivot = T_predicted[:2, 3].copy()
        prior = self._drift + np.diag(np.square(seen.odometry_floor))
        if self._lost and not seen.by_laser:
            return self._look_for_place(view, seen, T_predicted, prior)
        surface = seen.surest.near(pivot, RADIUS_M)
        reach = float(np.linalg.norm(surface.points_xy - pivot, axis=1).max()) + NEAR_M
        local_map = LocalMap(self._map.of(seen).near(pivot, reach))
        match = best_match(surface, local_map, pivot, prior)
        fits = match is not None and match.overlap >= GOOD_OVERLAP
        if (self._lost or self._probation) and fits and seen.by_laser:
            self._be_found(view, 0.0, 0.0)  # it sees all round: hardly by chance
        asked = not fits or self._probation
        beside = _beside_map(match, surface, local_map, pivot) if asked else NOT_COMPARED
        contradicted = not fits and (beside.disagrees if match is None else beside.contradicts)
        self._contradicted = self._contradicted + 1 if contradicted else 0
        if self._probation:
            if fits and match is not None and deviation(match, prior) < MAX_DEVIATION:
                return self._go_on_probation(view, seen, match, T_predicted, beside.confirms)
            self._doubt(view, contradicted)
        if self._lost or self._contradicted >= (1 if seen.by_laser else IMAGES_IN_A_ROW):
            return self._look_for_place(view, seen, T_predicted, prior)
        if contradicted:
            raise BadFrame(CONTRADICTED)
        if match is None:
            return self._go_on_by_odometry(view, seen, surface, local_map, T_predicted)
        self._covariance = inverse(match.information + inverse(prior))
        doubtful = seen.by_laser and not fits and beside.is_doubtful
        return self._settle(view, seen, match, T_predicted, doubtful)

    def _settle(
        self, view: View, seen: ViewSurface, match: Match, T_predicted: Array, doubtful: bool
    ) -> PlacedPose:
        """Believe a match: odometry is corrected, and the view becomes part of the map.

        A `doubtful` one doesn't, unless so are the next: it would double walls.
        """
        self._unmatched = self._unmatched + 1 if doubtful else 0
        corrected, placed = self._corrected(seen, match, T_predicted)
        if not doubtful or self._unmatched > UNMATCHED_VIEWS:
            self._map.take_in(view, corrected)
        else:
            self._map.keep_waiting(view)
        return placed

    def _corrected(
        self, seen: ViewSurface, match: Match, T_predicted: Array
    ) -> tuple[ViewSurface, PlacedPose]:
        """What is seen, and from where, where it matches; so is odometry from now on."""
        self._drift = np.zeros((3, 3))
        T_correction = about(T_predicted[:2, 3], match.motion)
        self._T_map_odom = T_correction @ self._T_map_odom
        moved = seen.moved(T_correction[:2, :2], T_correction[:2, 3])
        T_map_base = T_correction @ T_predicted
        return moved, PlacedPose(T_map_base, self._covariance, True, match.overlap)

    def _look_for_place(
        self, view: View, seen: ViewSurface, T_predicted: Array, prior: Array
    ) -> PlacedPose:
        """A lost robot looks for where its last views fit the map, near odometry or anywhere."""
        if not self._lost:
            self._record.withdraw(self._map.take_back())
        surface_map = self._map.of(seen)
        match = self._lost.look(view, seen, T_predicted, prior, surface_map, self._record)
        self._lost.end()
        self._covariance = inverse(match.information)
        shift, turn = float(np.hypot(*match.motion[:2])), float(np.degrees(match.motion[2]))
        if seen.by_laser:
            self._be_found(view, shift, turn)
            return self._settle(view, seen, match, T_predicted, doubtful=False)
        self._probation = Probation(view.T_odom_base, shift, turn)
        corrected, placed = self._corrected(seen, match, T_predicted)
        self._map.keep_waiting(view, corrected)
        return placed

    def _go_on_probation(
        self, view: View, seen: ViewSurface, match: Match, T_predicted: Array, confirmed: bool
    ) -> PlacedPose:
        """One more view is as the map has it; what is seen doesn't change the map yet."""
        assert self._probation is not None
        if not self._probation.is_news(view.T_odom_base):
            self._record.lose(view.index)
            raise BadFrame(WHY)
        self._covariance = inverse(match.information)
        corrected, placed = self._corrected(seen, match, T_predicted)
        self._map.keep_waiting(view, corrected)
        self._probation.count(view.T_odom_base, confirmed)
        if self._probation.is_passed:
            self._be_found(view, self._probation.metres, self._probation.degrees)
        return placed

    def _doubt(self, view: View, contradicted: bool) -> None:
        """A view on probation that doesn't fit: the place is given up, or at least not sure yet."""
        assert self._probation is not None
        self._probation.count(view.T_odom_base, confirmed=False)
        if not contradicted and not self._probation.is_failed:
            self._record.lose(view.index)
            raise BadFrame(WHY)
        self._record.withdraw(len(self.held.withdraw()))
        self._probation, self._contradicted = None, IMAGES_IN_A_ROW

    def _be_found(self, view: View, metres: float, degrees: float) -> None:
        """The robot is surely so far from where odometry had it; what it saw becomes map."""
        if self._probation:
            self._map.confirm()
        self._lost.end()
        self._probation = None
        self._record.find(view.index, metres, degrees)

    def _go_on_by_odometry(
        self,
        view: View,
        seen: ViewSurface,
        surface: SurfacePoints,
        local_map: LocalMap,
        T_predicted: Array,
    ) -> PlacedPose:
        """Keep odometry's pose; take the view in only where it can't double a wall."""
        self._unmatched += 1
        overlap, _ = agreement(surface, local_map)
        _, found = local_map.nearest(surface, NEAR_M)
        is_new = found.mean() < 1 - NEW_GROUND or self._unmatched > UNMATCHED_VIEWS
        if is_new and not compared(surface, local_map.surface, T_predicted[:2, 3]).disagrees:
            self._map.take_in(view, seen)
        else:
            self._map.keep_waiting(view)
        return PlacedPose(T_predicted, self._covariance + self._drift, False, overlap)


def _beside_map(
    match: Match | None, seen: SurfacePoints, local_map: LocalMap, pivot_xy: Array
) -> Comparison:
    """The view beside the map, where it matches best; where odometry has it if it matches not."""
    if match is None:
        return compared(seen, local_map.surface, pivot_xy)
    placed = apply_motion(match.motion, pivot_xy, seen)
    return compared(placed, local_map.surface, pivot_xy + match.motion[:2])
