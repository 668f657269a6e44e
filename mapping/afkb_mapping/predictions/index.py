"""What is expected, by where it is and in order of discovery."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.box_index import BoxIndex
from afkb_mapping.predictions.grounding import BELOW_MARGIN_M
from afkb_mapping.predictions.predicted_track import PredictedTrack

Array = NDArray[np.float64]


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

    def following_from(self, anchor: str) -> list[PredictedTrack]:
        """Predictions that follow from a thing, by its id, in order of discovery."""
        return self._boxes.in_order(dict(self._by_anchor.get(anchor, {})))

    def _forget_anchors(self, prediction: PredictedTrack) -> None:
        for anchor in self._anchors.pop(prediction, ()):
            others = self._by_anchor[anchor]
            del others[prediction]
            if not others:
                del self._by_anchor[anchor]
