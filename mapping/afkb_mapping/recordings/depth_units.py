"""Whether depth is in metres, as far as one can tell: a wrong factor makes giants or dwarfs."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np

from afkb.flow import View

NEAREST_M = 0.4
"""What depth cameras measure begins at 0.3 to 0.5 m: a recording half of which is nearer than this
is in other units."""
FARTHEST_M = 8.0
"""Depth cameras reach 4 to 10 m and rooms are rarely longer: half of a recording is not farther."""
_STEP_PIXELS = 16


@dataclass(slots=True)
class DepthsSeen:
    """The median depth of each view, m, of every 16th pixel of every 16th row."""

    medians: array[float] = field(default_factory=lambda: array("f"))

    def add(self, view: View) -> None:
        """Take note of a view's depth, if it has any."""
        if view.depth_m is None:
            return
        seen = view.depth_m[::_STEP_PIXELS, ::_STEP_PIXELS]
        seen = seen[seen > 0]
        if seen.size:
            self.medians.append(float(np.median(seen)))

    @property
    def note(self) -> str | None:
        """What to tell the user, None if the depths are a room's."""
        if not self.medians:
            return None
        middle = float(np.median(self.medians))
        if NEAREST_M <= middle <= FARTHEST_M:
            return None
        return (
            f"half of what was seen is {'nearer' if middle < NEAREST_M else 'farther'} than "
            f"{middle:.2g} m: is depth in metres? See the source's depth_scale (raw units a metre)"
        )
