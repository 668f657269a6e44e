"""Algorithm 1 of the paper: the topological affordance map, one viewpoint at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Closure, Detection, Hypothesis, TopologicalMap, View
from afkb.inference import Network
from afkb_mapping.bounds import BoundMerger
from afkb_mapping.doorways.merger import DoorwayMerger, passage_width
from afkb_mapping.grid.input import insert_view
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.ids import Ids
from afkb_mapping.places import Places
from afkb_mapping.predictions.endings import Ended, ends_counted
from afkb_mapping.predictions.entities import hazard_of_prediction
from afkb_mapping.predictions.expectations import Expectations
from afkb_mapping.predictions.predicted_track import PredictedTrack
from afkb_mapping.snapshot import MapContent, snapshot
from afkb_mapping.things.association import Association
from afkb_mapping.things.entities import hazard_of_track, is_kept
from afkb_mapping.things.looks import age, eye_of, look_at
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.things.visibility import Sight
from afkb_mapping.visits.persistence import AGED_EVERY_S, GONE_BELOW, HOUR_S


class AffordanceMapper:
    """Builds G(V_r ∪ V_ao ∪ V_ap ∪ V_ac, E_d ∪ E_l) in an occupancy grid (paper §II.E)."""

    works_from_memory = True

    def __init__(self, network: Network, rule: str) -> None:
        self._network = network
        new_id = Ids()
        self._association = Association(new_id, network)
        self._places = Places(new_id)
        self._bounds = BoundMerger()
        self._doorways = DoorwayMerger(passage_width(network.knowledge_base))
        self._grid = GridBuilder()
        tracks = self._association.tracks
        self._expectations = Expectations(
            rule,
            network.knowledge_base.parameters["FaintestHypothesis"],
            new_id,
            tracks,
            self._bounds,
            self._grid,
        )
        self._closures: list[tuple[Closure, NDArray[np.float64]]] = []
        self._trajectory: list[tuple[float, NDArray[np.float64]]] = []
        self._looked_from: list[NDArray[np.float64]] = []
        self._aged_at: float | None = None

    def add(
        self, view: View, detections: Sequence[Detection], hypotheses: Sequence[Hypothesis]
    ) -> None:
        """One viewpoint k of Algorithm 1; `view` is placed in the map frame."""
        self._enter(view)
        observed = self._association.match(view, detections)  # v_ao
        self._confirm(observed, view)  # v_ao ~ v_ap_m: p = 1, c = c_ao: loop closing
        expected = self._expectations.expect(hypotheses, detections, observed, view)  # v_ap, v_ac
        self._expectations.reinforce(expected, view)  # v_ap ~ v_ap_m: p rises, c = mean
        self._look_for_missing(view, observed)
        self._expectations.refute_doubtful(expected, view)
        self._link(view, detections, observed, expected)  # V_r, E_d, E_l

    def finish(self, T_map_source: NDArray[np.float64]) -> TopologicalMap:
        """The map of what was added so far."""
        self._association.merge_doubles()
        content = MapContent(
            network=self._network,
            tracks=list(self._association.tracks),
            predictions=list(self._expectations),
            places=self._places.places,
            ways=dict(self._places.ways),
            bounds=self._bounds.bounds(),
            doorways=self._doorways,
            grid=self._grid.grid(),
            closures=self._settled_closures(),
            trajectory=self._trajectory,
            looked_from=self._looked_from,
            counts={
                "births": self._association.births,
                "merges": self._association.merges,
                "splits": self._association.splits,
                **ends_counted(self._expectations.ended),
            },
            ended=self._expectations.ended,
            id_now=self._association.id_now,
        )
        return snapshot(content, T_map_source)

    def _enter(self, view: View) -> None:
        assert view.T_map_base is not None
        insert_view(self._grid, view)
        self._age(view.stamp)
        self._trajectory.append((view.stamp, view.T_map_base))
        if view.depth_m is not None:
            self._looked_from.append(view.T_map_base[:2, 3])

    def _age(self, stamp: float) -> None:
        """Let the time since the last views pass over all things: days, between two visits."""
        seconds = 0.0 if self._aged_at is None else stamp - self._aged_at
        if self._aged_at is None or seconds >= AGED_EVERY_S:
            self._aged_at = stamp
        if seconds < AGED_EVERY_S:
            return
        tracks = self._association.tracks
        if seconds >= HOUR_S:
            # A visit has ended: of a thing's doubles each would have to be seen to be gone.
            self._association.merge_doubles()
            # What was gone already leaves its place to what is put there.
            for track in [t for t in tracks if not t.is_floor and t.existence < GONE_BELOW]:
                tracks.remove(track)
                self._expectations.forget(track, stamp)
        self._expectations.age(seconds, stamp, lambda p: hazard_of_prediction(p, self._network))
        age(tracks, seconds, stamp, lambda track: hazard_of_track(track, self._network))

    def _confirm(self, observed: Sequence[ObservedTrack | None], view: View) -> None:
        """What is seen for sure gives a prediction its place; what is doubtful confirms nothing."""
        for track in dict.fromkeys(t for t in observed if t is not None and is_kept(t)):
            for ended in self._expectations.fulfilled_by(track, view):
                self._close(ended, track, view)

    def _close(self, ended: Ended, track: ObservedTrack, view: View) -> None:
        """A prediction comes true: it gives way to the observed node that replaces it."""
        prediction, current = ended.prediction, self._places.current
        closure = Closure(
            entity=track.id,
            predicted_as=prediction.kind,
            predicted_probability=ended.probability,
            displacement_m=0.0,
            place=current.id if current else "",
            stamp=view.stamp,
            predicted_stamp=prediction.first_seen,
        )
        self._closures.append((closure, prediction.center_xy))
        track.predicted_first = track.predicted_first or prediction.kind
        track.predicted_from.update(dict.fromkeys(prediction.anchors))
        track.axioms.update(prediction.axioms)

    def _settled_closures(self) -> list[Closure]:
        """Each with the node that it became, and how far that lies from where it was expected.

        At its first sight mostly a part of a thing shows.
        """
        tracks = {t.id: t for t in self._association.tracks}
        settled = []
        for closure, expected_xy in self._closures:
            track = tracks.get(self._association.id_now(closure.entity))
            if track is None:  # It was taken away, days ago.
                continue
            off = np.hypot(*(expected_xy - track.footprint.outline().center_xy))
            settled.append(replace(closure, entity=track.id, displacement_m=float(off)))
        return settled

    def _look_for_missing(self, view: View, observed: Sequence[ObservedTrack | None]) -> None:
        """What is seen through counts against; the paper has no such term."""
        seen = {t.id for t in observed if t is not None}
        sight, eye = Sight(view), eye_of(view)
        for track in self._association.tracks.near(*sight.reach):
            if track.id not in seen:
                look_at(track, sight, eye, view)
        self._expectations.look_for(sight, view)

    def _link(
        self,
        view: View,
        detections: Sequence[Detection],
        observed: Sequence[ObservedTrack | None],
        expected: Sequence[PredictedTrack],
    ) -> None:
        """Grow G_t: the place of this view, and what is linked to it."""
        in_view = {t.id: None for t in observed if t is not None and not t.is_floor}
        place = self._places.visit(view, in_view, self._grid)
        for track in observed:
            if track is not None:
                track.places[place.id] = None
        for prediction in expected:
            prediction.places[place.id] = None
        self._doorways.add(view, detections)
        for detection in detections:
            if detection.segment_xy is not None:
                self._bounds.add(detection, place.id, view.stamp)
