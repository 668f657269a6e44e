"""Algorithm 1 of the paper: the topological affordance map, one viewpoint at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Closure, Detection, Hypothesis, Relation, TopologicalMap, View
from afkb.inference import Network
from afkb_mapping.bounds import BoundMerger
from afkb_mapping.doorways.merger import DoorwayMerger, passage_width
from afkb_mapping.grid.input import insert_view
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.grounding import fits, ground, joined, same_prediction
from afkb_mapping.ids import Ids
from afkb_mapping.places import Places
from afkb_mapping.predicted_track import PredictedTrack
from afkb_mapping.snapshot import MapContent, snapshot
from afkb_mapping.things.association import Association
from afkb_mapping.things.entities import hazard_of_track, is_kept
from afkb_mapping.things.looks import age, eye_of, look_at, look_for
from afkb_mapping.things.standing import support_of
from afkb_mapping.things.track_index import PredictionIndex
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.things.visibility import Sight
from afkb_mapping.update_rules import update_rule
from afkb_mapping.visits.persistence import AGED_EVERY_S, GONE_BELOW, HOUR_S


class AffordanceMapper:
    """Builds G(V_r ∪ V_ao ∪ V_ap ∪ V_ac, E_d ∪ E_l) in an occupancy grid (paper §II.E)."""

    works_from_memory = True

    def __init__(self, network: Network, rule: str) -> None:
        self._network = network
        self._rule = update_rule(rule)
        self._new_id = Ids()
        self._association = Association(self._new_id, network)
        self._places = Places(self._new_id)
        self._bounds = BoundMerger()
        self._doorways = DoorwayMerger(passage_width(network.knowledge_base))
        self._grid = GridBuilder()
        self._predictions = PredictionIndex()
        self._closures: list[tuple[Closure, NDArray[np.float64]]] = []
        self._trajectory: list[tuple[float, NDArray[np.float64]]] = []
        self._looked_from: list[NDArray[np.float64]] = []
        self._refuted = 0
        self._aged_at: float | None = None

    def add(
        self, view: View, detections: Sequence[Detection], hypotheses: Sequence[Hypothesis]
    ) -> None:
        """One viewpoint k of Algorithm 1; `view` is placed in the map frame."""
        self._enter(view)
        observed = self._association.match(view, detections)  # v_ao
        self._confirm(observed, view)  # v_ao ~ v_ap_m: p = 1, c = c_ao: loop closing
        expected = self._expect(hypotheses, detections, observed, view)  # v_ap, v_ac
        self._reinforce(expected, view)  # v_ap ~ v_ap_m: p rises, c = mean
        self._look_for_missing(view, observed)
        self._refute_doubtful(expected)
        self._link(view, detections, observed, expected)  # V_r, E_d, E_l

    def finish(self, T_map_source: NDArray[np.float64]) -> TopologicalMap:
        """The map of what was added so far."""
        self._association.merge_doubles()
        content = MapContent(
            network=self._network,
            tracks=list(self._association.tracks),
            predictions=list(self._predictions),
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
                "refuted": self._refuted,
            },
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
        age(tracks, seconds, lambda track: hazard_of_track(track, self._network))

    def _confirm(self, observed: Sequence[ObservedTrack | None], view: View) -> None:
        """What is seen for sure gives a prediction its place; what is doubtful confirms nothing."""
        for track in dict.fromkeys(t for t in observed if t is not None and is_kept(t)):
            extent = track.footprint.extent()
            near = self._predictions.near(*extent) if extent else []
            for prediction in [p for p in near if fits(p, track)]:
                self._close(prediction, track, view)

    def _close(self, prediction: PredictedTrack, track: ObservedTrack, view: View) -> None:
        """A prediction comes true: it gives way to the observed node that replaces it."""
        current = self._places.current
        closure = Closure(
            entity=track.id,
            predicted_as=prediction.kind,
            predicted_probability=prediction.probability,
            displacement_m=0.0,
            place=current.id if current else "",
            stamp=view.stamp,
            predicted_stamp=prediction.first_seen,
        )
        self._closures.append((closure, prediction.center_xy))
        track.predicted_first = track.predicted_first or prediction.kind
        track.predicted_from.update(prediction.anchors)
        track.axioms.update(prediction.axioms)
        self._predictions.remove(prediction)

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

    def _expect(
        self,
        hypotheses: Sequence[Hypothesis],
        detections: Sequence[Detection],
        observed: Sequence[ObservedTrack | None],
        view: View,
    ) -> list[PredictedTrack]:
        """Hypotheses with a place in the map, without those that something seen already fulfils."""
        expected = []
        for hypothesis in hypotheses:
            anchors = [t for i in hypothesis.anchors if (t := observed[i]) is not None]
            if not anchors:
                continue
            if hypothesis.relation is Relation.BELOW and self._all_stand(anchors):
                continue
            hidden = not any("support_height" in detections[i].measures for i in hypothesis.anchors)
            track = ground(hypothesis, anchors, hidden, view, self._grid, self._bounds)
            if track is not None and not self._fulfilled(track):
                expected.append(track)
        return expected

    def _all_stand(self, anchors: Sequence[ObservedTrack]) -> bool:
        """Whether what carries each anchor has been seen."""
        tracks = self._association.tracks
        return all(
            support_of(anchor, [t for t in tracks.carriers(anchor) if is_kept(t)]) is not None
            for anchor in anchors
        )

    def _fulfilled(self, prediction: PredictedTrack) -> bool:
        near = self._association.tracks.near(*prediction.place())
        return any(fits(prediction, t) for t in near if is_kept(t))

    def _reinforce(self, expected: list[PredictedTrack], view: View) -> None:
        """Raise earlier predictions that this viewpoint makes again; add the new ones."""
        for i, prediction in enumerate(expected):
            like = self._predictions.like(prediction)
            old = next((p for p in like if same_prediction(p, prediction)), None)
            if old is None:
                prediction.id = self._new_id("predicted")
                prediction.viewpoints.is_new(eye_of(view), prediction.center_xy)
                self._predictions.put(prediction)
                continue
            if old.viewpoints.is_new(eye_of(view), old.center_xy):
                old.probability = self._rule(old.probability, prediction.probability)
                old.observations += 1
            joined(old, prediction)
            self._predictions.put(old)
            expected[i] = old

    def _look_for_missing(self, view: View, observed: Sequence[ObservedTrack | None]) -> None:
        """What is seen through counts against; the paper has no such term."""
        seen = {t.id for t in observed if t is not None}
        sight, eye = Sight(view), eye_of(view)
        in_reach = sight.reach()
        for track in self._association.tracks.near(*in_reach):
            if track.id not in seen:
                look_at(track, sight, eye)
        for prediction in self._predictions.near(*in_reach):
            look_for(prediction, sight, eye)
            if prediction.probability < GONE_BELOW:
                self._refute(prediction)

    def _refute_doubtful(self, expected: Sequence[PredictedTrack]) -> None:
        """Refute what is too unlikely, or has a wall between it and what it is near to.

        Only news may have changed that: of these `expected` ones, or of walls since the last view.
        """
        doubtful = dict.fromkeys(expected)
        for low, high in self._bounds.changed():
            doubtful.update(dict.fromkeys(self._predictions.near(low, high)))
        for prediction in doubtful:
            if prediction not in self._predictions:
                continue
            if prediction.probability < GONE_BELOW or self._is_walled_off(prediction):
                self._refute(prediction)

    def _refute(self, prediction: PredictedTrack) -> None:
        self._predictions.remove(prediction)
        self._refuted += 1

    def _is_walled_off(self, prediction: PredictedTrack) -> bool:
        """Whether a wall has come to light between a prediction and what it is near to."""
        near = prediction.near_xy
        return near is not None and self._bounds.part(near, prediction.center_xy)

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
