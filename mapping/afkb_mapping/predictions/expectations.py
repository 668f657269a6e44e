"""What is expected and not seen yet: grounded, made surer, given up (paper §II.D, Algorithm 1)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, Hypothesis, Relation, View
from afkb.inference.update_rules import update_rule
from afkb_mapping.bounds import BoundMerger
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.ids import Ids
from afkb_mapping.predictions.grounding import fits, ground, joined, same_prediction
from afkb_mapping.predictions.index import PredictionIndex
from afkb_mapping.predictions.predicted_track import PredictedTrack
from afkb_mapping.things.entities import is_kept
from afkb_mapping.things.looks import eye_of, look_for
from afkb_mapping.things.standing import support_of
from afkb_mapping.things.track_index import TrackIndex
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.things.visibility import Sight
from afkb_mapping.visits.persistence import GONE_BELOW


class Expectations:
    """The predicted nodes V_ap and V_ac, in order of discovery.

    They are placed by what is known of things (`tracks`), walls and the grid, which others fill.
    `rule`: name of the rule that makes a repeated prediction surer. `refuted`: how many were given
    up.
    """

    def __init__(
        self, rule: str, new_id: Ids, tracks: TrackIndex, bounds: BoundMerger, grid: GridBuilder
    ) -> None:
        self.refuted = 0
        self._rule, self._new_id = update_rule(rule), new_id
        self._tracks, self._bounds, self._grid = tracks, bounds, grid
        self._index = PredictionIndex()

    def __iter__(self) -> Iterator[PredictedTrack]:
        return iter(self._index)

    def fulfilled_by(self, track: ObservedTrack) -> list[PredictedTrack]:
        """Those that come true with a thing that is seen for sure; they expect nothing more."""
        extent = track.footprint.extent()
        near = self._index.near(*extent) if extent else []
        fulfilled = [p for p in near if fits(p, track)]
        for prediction in fulfilled:
            self._index.remove(prediction)
        return fulfilled

    def expect(
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
        tracks = self._tracks
        return all(
            support_of(anchor, [t for t in tracks.carriers(anchor) if is_kept(t)]) is not None
            for anchor in anchors
        )

    def _fulfilled(self, prediction: PredictedTrack) -> bool:
        near = self._tracks.near(*prediction.place())
        return any(fits(prediction, t) for t in near if is_kept(t))

    def reinforce(self, expected: list[PredictedTrack], view: View) -> None:
        """Raise earlier predictions that this viewpoint makes again; add the new ones."""
        for i, prediction in enumerate(expected):
            like = self._index.like(prediction)
            old = next((p for p in like if same_prediction(p, prediction)), None)
            if old is None:
                prediction.id = self._new_id("predicted")
                prediction.viewpoints.is_new(eye_of(view), prediction.center_xy)
                self._index.put(prediction)
                continue
            if old.viewpoints.is_new(eye_of(view), old.center_xy):
                old.probability = self._rule(old.probability, prediction.probability)
                old.observations += 1
            joined(old, prediction)
            self._index.put(old)
            expected[i] = old

    def look_for(self, sight: Sight, eye: NDArray[np.float64]) -> None:
        """What is seen through, where a prediction says that something is, counts against it."""
        for prediction in self._index.near(*sight.reach):
            look_for(prediction, sight, eye)
            if prediction.probability < GONE_BELOW:
                self._refute(prediction)

    def refute_doubtful(self, expected: Sequence[PredictedTrack]) -> None:
        """Refute what is too unlikely, or has a wall between it and what it is near to.

        Only news may have changed that: of these `expected` ones, or of walls since the last view.
        """
        doubtful = dict.fromkeys(expected)
        for low, high in self._bounds.changed():
            doubtful.update(dict.fromkeys(self._index.near(low, high)))
        for prediction in doubtful:
            if prediction not in self._index:
                continue
            if prediction.probability < GONE_BELOW or self._is_walled_off(prediction):
                self._refute(prediction)

    def _refute(self, prediction: PredictedTrack) -> None:
        self._index.remove(prediction)
        self.refuted += 1

    def _is_walled_off(self, prediction: PredictedTrack) -> bool:
        """Whether a wall has come to light between a prediction and what it is near to."""
        near = prediction.near_xy
        return near is not None and self._bounds.part(near, prediction.center_xy)
