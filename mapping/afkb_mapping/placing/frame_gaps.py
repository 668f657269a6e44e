"""Frames that a recording should have and has not, by the gaps between its stamps."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

ALIKE = 0.25
"""Steps of a regular recording stay within this part of the usual one."""
REGULAR = 0.5
"""A recording most of whose steps are alike has a usual step; others, such as one that takes a
frame at each stop, have none that a gap could be told by."""
LEAST_FRAMES = 10
"""Fewer frames show no usual step."""


@dataclass(slots=True)
class FrameGaps:
    """The frames that came, by their stamps (s) and their indices in the recording."""

    _stamps: list[float] = field(default_factory=list)
    _indices: list[int] = field(default_factory=list)

    def see(self, stamp: float, index: int) -> None:
        """One more frame that came."""
        self._stamps.append(stamp)
        self._indices.append(index)

    @property
    def lost(self) -> int:
        """How many frames are missing; 0 where there is no usual step."""
        return int(self._missing().sum())

    @property
    def note(self) -> str | None:
        """A line on what is missing; None where nothing is."""
        missing = self._missing()
        if not missing.any():
            return None
        steps, worst = np.diff(self._stamps), int(np.argmax(missing))
        share = self.lost / (self.lost + len(self._stamps))
        return (
            f"about {self.lost} frames ({share:.0%}) are missing from the recording, by its "
            f"stamps; the greatest gap is {steps[worst]:.3g} s, after frame {self._indices[worst]}"
        )

    def _missing(self) -> NDArray[np.intp]:
        """After each frame but the last: how many usual steps the next is late.

        Frames that are there but could not be read are none.
        """
        if len(self._stamps) < LEAST_FRAMES:
            return np.zeros(0, np.intp)
        steps, apart = np.diff(self._stamps), np.diff(self._indices)
        per_frame = steps / apart
        usual = float(np.median(per_frame))
        if usual <= 0 or (np.abs(per_frame - usual) < ALIKE * usual).mean() < REGULAR:
            return np.zeros(0, np.intp)
        late = np.round(steps / usual).astype(np.intp) - apart
        return np.where(late * usual > (1 - ALIKE) * usual * apart, late, 0)
