"""What beliefs of a map rest on: the sightings of a thing, and the steps of its existence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum


@dataclass(frozen=True, slots=True)
class Sighting:
    """Which pixels of which view showed a thing, and what the detectors made of them.

    - `view`: index of the view in the recording; `stamp`: s. `detectors`: the first to speak first.
    - `n_pixels`, `image_box` (u0, v0, u1, v1, half-open), `range_m`: as of `Detection`; what counts
      beams has no image box.
    - `affordances`: feature to the probability that this view alone gave it.
    """

    view: int
    stamp: float
    detectors: tuple[str, ...]
    n_pixels: int
    range_m: float
    image_box: tuple[int, int, int, int] | None = None
    affordances: Mapping[str, float] = field(default_factory=dict)


class ChangeKind(StrEnum):
    """What changed the probability that something exists."""

    SIGHTED = "Sighted"
    SEEN_THROUGH = "SeenThrough"
    OVERLOOKED = "Overlooked"
    SURROUNDED = "Surrounded"
    AGED = "Aged"
    PREDICTED = "Predicted"
    PREDICTED_AGAIN = "PredictedAgain"
    WALLED_OFF = "WalledOff"
    EVIDENCE_GONE = "EvidenceGone"
    CONFIRMED = "Confirmed"


@dataclass(frozen=True, slots=True)
class Change:
    """One step in the life of a thing or of a prediction: its probability before and after.

    - `evidence`: what the step weighs, as `afkb.inference.existence.after` takes it: a sighting's
      or prediction's strength, a look's likelihood ratio, the share that time leaves.
    - `before`: None where this is the first that is known of it. `view`: index, where a view did
      it; `stamp`: s. `by`: ids of the things that spoke for a prediction, or confirmed it.
    """

    kind: ChangeKind
    evidence: float
    before: float | None
    after: float
    stamp: float
    view: int | None = None
    by: tuple[str, ...] = ()
