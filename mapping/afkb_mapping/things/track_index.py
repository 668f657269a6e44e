"""What is seen and what is expected, each by where it is and in order of discovery."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.box_index import BoxIndex
from afkb_mapping.grounding import BELOW_MARGIN_M
from afkb_mapping.predicted_track import PredictedTrack
from afkb_mapping.things.tracks import SURFACE_CELL_M, ObservedTrack

Array = NDArray[np.float64]

STANDS_REACH_M = 3 * SURFACE_CELL_M
"""What carries a thing lies below it, within the cells that `support_of` allows."""


class TrackIndex:
    """The observed tracks in order of birth; those but the floor also by place."""

    def __init__(self) -> None:
        self._tracks: dict[str, ObservedTrack] = {}
        self._ranks: dict[str, int] = {}
        self._boxes: BoxIndex[ObservedTrack] = BoxIndex()
        self._floors: dict[str, ObservedTrack] = {}
        self._born = 0

    @classmethod
    def of(cls, tracks: Iterable[ObservedTrack]) -> TrackIndex:
        """An index of tracks that have their places."""
        index = cls()
        for track in tracks:
            index.add(track)
            index.moved(track)
        return index

    def __len__(self) -> int:
        return len(self._tracks)

    def __iter__(self) -> Iterator[ObservedTrack]:
        return iter(list(self._tracks.values()))

    def __contains__(self, track: ObservedTrack) -> bool:
        return self._tracks.get(track.id) is track

    def __getitem__(self, id_: str) -> ObservedTrack:
        return self._tracks[id_]

    @property
    def floor(self) -> ObservedTrack | None:
        """The floor that was seen first, or None."""
        return next(iter(self._floors.values()), None)

    def rank(self, track: ObservedTrack) -> int:
        """Its number in order of birth: less than that of every younger one."""
        return self._ranks[track.id]

    def add(self, track: ObservedTrack) -> None:
        """Take in a new track; it has no place before `moved` is told of one."""
        self._tracks[track.id] = track
        self._ranks[track.id] = self._born
        self._born += 1
        if track.is_floor:
            self._floors[track.id] = track

    def moved(self, track: ObservedTrack) -> None:
        """Note where a track is now: to be called whenever its footprint has changed."""
        extent = track.footprint.extent()
        if extent is not None and not track.is_floor:
            self._boxes.put(track, *extent)

    def remove(self, track: ObservedTrack) -> None:
        """Take a track out; `KeyError` if it is not there."""
        del self._tracks[track.id], self._ranks[track.id]
        self._floors.pop(track.id, None)
        if track in self._boxes:
            self._boxes.remove(track)

    def near(self, low_xy: Array, high_xy: Array) -> list[ObservedTrack]:
        """Tracks but the floor that may have a part in a box, m, in order of birth."""
        return sorted(self._boxes.near(low_xy, high_xy), key=lambda t: self._ranks[t.id])

    def carriers(self, track: ObservedTrack) -> list[ObservedTrack]:
        """Surfaces that may carry a track: those under it in order of birth, then the floor."""
        points = track.footprint.points()
        near = self.near(points.min(axis=0) - STANDS_REACH_M, points.max(axis=0) + STANDS_REACH_M)
        surfaces = [t for t in near if t.is_surface]
        return surfaces if self.floor is None else [*surfaces, self.floor]


class PredictionIndex:
    """The predictions in order of discovery, by their `domain` and by what they follow from."""

    def __init__(self) -> None:
        self._boxes: BoxIndex[PredictedTrack] = BoxIndex()
        self._by_anchor: dict[str, dict[PredictedTrack, None]] = {}
        self._anchors: dict[PredictedTrack, tuple[str, ...]] = {}

    def __len__(self) -> int:
        return len(self._boxes)

    def __iter__(self) -> Iterator[PredictedTrack]:
        return iter(self._boxes)

    def __contains__(self, prediction: PredictedTrack) -> bool:
        return prediction in self._boxes

    def put(self, prediction: PredictedTrack) -> None:
        """Take in a prediction, or note its place and anchors once they have changed."""
        self._boxes.put(prediction, *prediction.domain())
        self._forget_anchors(prediction)
        self._anchors[prediction] = tuple(prediction.anchors)
        for anchor in prediction.anchors:
            self._by_anchor.setdefault(anchor, {})[prediction] = None

    def remove(self, prediction: PredictedTrack) -> None:
        """Take a prediction out; `KeyError` if it is not there."""
        self._boxes.remove(prediction)
        self._forget_anchors(prediction)

    def near(self, low_xy: Array, high_xy: Array) -> list[PredictedTrack]:
        """Predictions whose domain may have a part in a box, m, in order of discovery."""
        return self._boxes.near(low_xy, high_xy)

    def like(self, prediction: PredictedTrack) -> list[PredictedTrack]:
        """Predictions that may expect the same thing: near by, or of the same anchors."""
        low, high = prediction.place()
        slack = 2 * BELOW_MARGIN_M
        found = dict.fromkeys(self._boxes.near(low - slack, high + slack))
        for anchor in prediction.anchors:
            found.update(self._by_anchor.get(anchor, {}))
        return self._boxes.in_order(found)

    def _forget_anchors(self, prediction: PredictedTrack) -> None:
        for anchor in self._anchors.pop(prediction, ()):
            others = self._by_anchor[anchor]
            del others[prediction]
            if not others:
                del self._by_anchor[anchor]
