"""What a view leaves behind: where it was taken, and mostly the view itself."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.memory.packing import unpacked
from afkb_mapping.memory.remembered import RememberedView

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Passed:
    """Where the base was at one moment, which every view tells, remembered or not.

    - `visit`: number of the visit, from 0. `stamp`: s, the map's clock.
    - `T_placed` (4, 4): where the view was placed as it came in.
    - `T_settled` (4, 4): where it turned out to have been taken, once loops were closed.
    - `content`: the remembered view, packed, as it was first placed; empty where none is kept.
    """

    visit: int
    stamp: float
    T_placed: Array
    T_settled: Array
    content: bytes = b""

    @property
    def T_correction(self) -> Array:
        """(4, 4): what closing loops moved it by, in the map frame."""
        if np.array_equal(self.T_settled, self.T_placed):
            return np.eye(4)
        T: Array = self.T_settled @ np.linalg.inv(self.T_placed)
        return T


class RememberedViews:
    """The remembered views in the order they came in; each is unpacked whenever it is asked for."""

    def __init__(self, passed: Iterable[Passed], settled: bool) -> None:
        self._kept = [p for p in passed if p.content]
        self._settled = settled

    def __len__(self) -> int:
        return len(self._kept)

    def __getitem__(self, index: int) -> RememberedView:
        passed = self._kept[index]
        T_map_base = passed.T_settled if self._settled else passed.T_placed
        return unpacked(passed.content).moved_to(T_map_base)

    def __iter__(self) -> Iterator[RememberedView]:
        return (self[index] for index in range(len(self)))
