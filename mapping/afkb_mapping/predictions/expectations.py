"""What is expected and not seen yet: grounded, made surer, given up (paper §II.D, Algorithm 1)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from afkb.flow import ChangeKind, Detection, Hypothesis, PredictionState, Relation, View
from afkb.inference.update_rules import in_part, update_rule
from afkb_mapping.bounds import BoundMerger
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.ids import Ids
from afkb_mapping.predictions.endings import Ended
from afkb_mapping.predictions.grounding import ground
from afkb_mapping.predictions.index import PredictionIndex
from afkb_mapping.predictions.matching import fits, joined, same_prediction
from afkb_mapping.predictions.predicted_track import PredictedTrack
from afkb_mapping.predictions.whereabouts import TELLING
from afkb_mapping.things.entities import is_kept
from afkb_mapping.things.looks import eye_of
from afkb_mapping.things.standing import support_of
from afkb_mapping.things.track_index import TrackIndex
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.things.viewpoints import Viewpoints
from afkb_mapping.things.visibility import Sight
from afkb_mapping.visits.persistence import GONE_BELOW, HOUR_S, aged


class Expectations:
    """The predicted nodes V_ap and V_ac, in order of discovery.

    They are placed by what is known of things (`tracks`), walls and the grid, which others fill.
    `rule`: name of the rule that makes a repeated prediction surer; `faintest`: what is less
    probable is not entered. `ended`: what is expected no more, and why.
    """

    def __init__(
        self,
        rule: str,
        faintest: float,
        new_id: Ids,
        tracks: TrackIndex,
        bounds: BoundMerger,
        grid: GridBuilder,
    ) -> None:
        self.ended: list[Ended] = []
        self._rule, self._update, self._new_id = rule, update_rule(rule), new_id
        self._tracks, self._bounds, self._grid = tracks, bounds, grid
        self._faintest = faintest
        self._index, self._refuted = PredictionIndex(), PredictionIndex()

    def __iter__(self) -> Iterator[PredictedTrack]:
        return iter(self._index)

    def fulfilled_by(self, track: ObservedTrack, view: View) -> list[Ended]:
        """Those that come true with a thing that is seen for sure; they expect nothing more."""
        extent = track.footprint.extent()
        near = self._index.near(*extent) if extent else []
        fulfilled = [p for p in near if fits(p, track, self._bounds)]
        for prediction in fulfilled:
            self._end(prediction, PredictionState.CONFIRMED, view.stamp, track.id)
            at = view.stamp, view.index
            prediction.life.take(ChangeKind.CONFIRMED, 1.0, *at, by=(track.id,))
        return self.ended[len(self.ended) - len(fulfilled) :]

    def expect(
        self,
        hypotheses: Sequence[Hypothesis],
        detections: Sequence[Detection],
        observed: Sequence[ObservedTrack | None],
        view: View,
    ) -> list[PredictedTrack]:
        """Hypotheses with a place in the map, without those that something seen already fulfils.

        The lower orders of filtration come first: theirs is what others join (§II.D).
        """
        expected = []
        for hypothesis in sorted(hypotheses, key=lambda h: h.order):
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
        return any(fits(prediction, t, self._bounds) for t in near if is_kept(t))

    def reinforce(self, expected: list[PredictedTrack], view: View) -> None:
        """Raise earlier predictions that this viewpoint makes again; add the new ones."""
        for i, prediction in enumerate(expected):
            like = self._index.like(prediction)
            old = next((p for p in like if same_prediction(p, prediction)), None)
            if old is None:
                self._begin(prediction, view)
                continue
            self._strengthen(old, prediction, view)
            ratio = joined(old, prediction)
            self._index.put(old)
            self._take_against(old, ChangeKind.SEEN_THROUGH, ratio, view)
            expected[i] = old

    def _begin(self, prediction: PredictedTrack, view: View) -> None:
        """Enter what the axiom says, less what has been seen of the place already.

        Looks that refuted the same once go on telling: it does not begin anew in the next view.
        """
        for refuted in self._refuted.like(prediction):
            if refuted.axioms.keys() & prediction.axioms.keys():
                prediction.where.takes_looks_of(refuted.where)
        prediction.life.rule = self._update
        at = view.stamp, view.index
        prediction.life.take(ChangeKind.PREDICTED, prediction.strength, *at, by=prediction.anchors)
        seen = prediction.where.open_share
        if seen < 1 - TELLING:
            prediction.life.take(ChangeKind.SEEN_THROUGH, seen, *at)
        if prediction.probability >= self._faintest:
            prediction.id = self._new_id("predicted")
            prediction.viewpoints.is_new(eye_of(view), prediction.center_xy)
            self._index.put(prediction)

    def _strengthen(self, old: PredictedTrack, new: PredictedTrack, view: View) -> None:
        """A distinct viewpoint counts for what is new in it.

        Another thing, or another axiom, is a piece of evidence of its own. The same thing seen once
        more is the same evidence: what it adds is that the thing itself has become surer.
        """
        if not old.viewpoints.is_new(eye_of(view), old.center_xy):
            new.anchors = {a: old.anchors.get(a, p) for a, p in new.anchors.items()}
            return
        share = 1.0
        if new.axioms.keys() <= old.axioms.keys() and new.anchors.keys() <= old.anchors.keys():
            grown = [p - old.anchors[a] for a, p in new.anchors.items()]
            share = min(max(*grown, 0.0), 1.0)
        old.observations += 1
        if share > 0:
            evidence = in_part(self._rule, new.strength, share)
            at = view.stamp, view.index
            old.life.take(ChangeKind.PREDICTED_AGAIN, evidence, *at, by=new.anchors)

    def look_for(self, sight: Sight, view: View) -> None:
        """What is seen through, where a prediction says that something is, counts against it."""
        for prediction in self._index.near(*sight.reach):
            ratio = prediction.where.look(sight, prediction.tops_looked_at_m)
            self._take_against(prediction, ChangeKind.SEEN_THROUGH, ratio, view)
            if prediction.is_small and prediction in self._index:
                self._look_closely(prediction, sight, view)

    def _look_closely(self, prediction: PredictedTrack, sight: Sight, view: View) -> None:
        """What is small is not seen through: that it is not detected in clear view counts."""
        where = prediction.where
        clear = where.in_clear_view(sight, prediction.top_range_m)
        if clear.any() and prediction.missed_from.is_new(eye_of(view), prediction.center_xy):
            self._take_against(prediction, ChangeKind.OVERLOOKED, where.overlook(clear), view)

    def refute_doubtful(self, expected: Sequence[PredictedTrack], view: View) -> None:
        """Take in the walls between predictions and what they are near to.

        Only news may have changed that: of these `expected` ones, or of walls since the last view.
        """
        doubtful = dict.fromkeys(expected)
        for low, high in self._bounds.changed():
            doubtful.update(dict.fromkeys(self._index.near(low, high)))
        for prediction in doubtful:
            near = prediction.near_xy
            if prediction in self._index and near is not None:
                parted = self._bounds.part_from(near, prediction.where.points_xy)
                ratio = prediction.where.rule_out(parted)
                self._take_against(prediction, ChangeKind.WALLED_OFF, ratio, view)

    def age(self, seconds: float, stamp: float, hazard: Callable[[PredictedTrack], float]) -> None:
        """Let time pass; `hazard`: the rate, 1/s, at which such things are taken away."""
        if seconds >= HOUR_S:
            self._refuted = PredictionIndex()
        for prediction in list(self._index):
            prediction.decayed = True
            left = aged(1.0, seconds, hazard(prediction))
            prediction.life.take(ChangeKind.AGED, left, stamp)
            if seconds >= HOUR_S:
                prediction.where.forget_looks()
                prediction.missed_from = Viewpoints()
            if prediction.probability < GONE_BELOW:
                self._end(prediction, PredictionState.EXPIRED, stamp)

    def forget(self, track: ObservedTrack, stamp: float) -> None:
        """A thing has been taken away: what followed from it alone is expected no more."""
        for prediction in self._index.following_from(track.id):
            del prediction.anchors[track.id]
            if prediction.anchors:
                self._index.put(prediction)
                continue
            self._end(prediction, PredictionState.EXPIRED, stamp)
            prediction.life.take(ChangeKind.EVIDENCE_GONE, 0.0, stamp, by=(track.id,))

    def _take_against(
        self, prediction: PredictedTrack, kind: ChangeKind, ratio: float, view: View
    ) -> None:
        if abs(ratio - 1) > TELLING:
            prediction.decayed |= ratio < 1
            prediction.life.take(kind, ratio, view.stamp, view.index)
        if prediction.probability < GONE_BELOW:
            self._end(prediction, PredictionState.REFUTED, view.stamp)

    def _end(
        self,
        prediction: PredictedTrack,
        state: PredictionState,
        stamp: float,
        seen_as: str | None = None,
    ) -> None:
        self._index.remove(prediction)
        if state is PredictionState.REFUTED:
            self._refuted.put(prediction)
        before = prediction.life.history[-1].before if state is PredictionState.REFUTED else None
        probability = prediction.probability if before is None else before
        self.ended.append(Ended(prediction, state, stamp, probability, seen_as))
