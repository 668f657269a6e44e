"""Loops: places that a robot saw again, or may have, as plain data."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum


class LoopKind(StrEnum):
    """What a loop was recognised by; values are OWL individuals."""

    SCAN = "ScanMatch"
    CONSTELLATION = "Constellation"
    PREDICTION = "PredictionSeen"
    SHARED_SPACE = "SharedSpace"


@dataclass(frozen=True, slots=True)
class LoopProposal:
    """Two views that may be of one place, and what came of it (paper §II.D.ii and iii, §II.E).

    - `view`, `earlier_view`: indexes of the views, taken at `stamp` and `earlier_stamp` (s), in the
      places `place` and `earlier_place`.
    - `weight`: evidence for it, as its kind counts it: landmarks' summed weights, or a share.
    - `accepted`: it corrected the robot's way. `reason`: why, or why not.
    - `relative`: x, y (m), yaw (rad) of the later view's base as seen from the earlier one's, of an
      accepted one.
    - `corrected_m`, `corrected_rad`: what it found the views' relative pose to be off by; NaN where
      nothing was found.
    """

    kind: LoopKind
    view: int
    earlier_view: int
    stamp: float
    earlier_stamp: float
    weight: float
    accepted: bool
    reason: str
    corrected_m: float = math.nan
    corrected_rad: float = math.nan
    relative: tuple[float, float, float] | None = None
    place: str = ""
    earlier_place: str = ""
