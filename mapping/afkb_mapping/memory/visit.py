"""One visit to a place: the recording that a part of a map comes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View


@dataclass(frozen=True, slots=True, eq=False)
class Visit:
    """A recording in a map, and how its clock and its numbering of views follow earlier ones'.

    - `source`: what it was opened from. `parameters`: what the run was asked for, as in run.json.
    - `T_map_source` (4, 4): from its pose frame to the map frame, at its first view.
    - `frames`: how many the recording has; `first_index`: number of its frame 0 among all visits'.
    - `clock_offset_s`: what its stamps lack to the map's clock, which is the first visit's.
    - `notes`: what had to be assumed to begin it.
    """

    source: str
    parameters: Mapping[str, Any]
    T_map_source: NDArray[np.float64]
    frames: int
    first_index: int = 0
    clock_offset_s: float = 0.0
    notes: tuple[str, ...] = ()

    def numbered(self, view: View) -> View:
        """A view of its recording, with its number and time in the map."""
        if not self.first_index and not self.clock_offset_s:
            return view
        return replace(
            view, index=view.index + self.first_index, stamp=view.stamp + self.clock_offset_s
        )

    def as_json(self) -> dict[str, Any]:
        """All of it, for run.json and `state/`."""
        return {
            "source": self.source,
            "parameters": dict(self.parameters),
            "T_map_source": self.T_map_source.tolist(),
            "frames": self.frames,
            "first_index": self.first_index,
            "clock_offset_s": self.clock_offset_s,
            "notes": list(self.notes),
        }

    @classmethod
    def from_json(cls, told: Mapping[str, Any]) -> Visit:
        """The inverse of `as_json`; raises `KeyError` or `ValueError` for anything else."""
        T = np.array(told["T_map_source"], dtype=np.float64).reshape(4, 4)
        return cls(
            str(told["source"]),
            dict(told["parameters"]),
            T,
            int(told["frames"]),
            int(told["first_index"]),
            float(told["clock_offset_s"]),
            tuple(map(str, told["notes"])),
        )
