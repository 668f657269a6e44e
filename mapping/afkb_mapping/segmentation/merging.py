"""Faces become rooms: those are one that share more opening than wall, the longest opening first.

A line that a wall's end points along is a border of rooms only where walls stand on most of it, or
enough: a doorway, or an opening with wall to either side. Across a room it is all open.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.segmentation.borders import Border

Array = NDArray[np.float64]
Labels = NDArray[np.int32]
Pair = tuple[int, int]
Offer = tuple[float, int, int, int, int]
"""Longest opening first; two faces, and how often either had been joined when it was made."""

OPEN = 0.7
"""Two faces are of one room where more of their border is open. In drawn plans people cut openings
of two thirds of a wall, and leave those of four fifths."""
DOOR_M, OF_WIDTH = 1.3, 0.4
"""An opening no wider than the widest single door with its frame, and than this part of the wider
of its sides, is a doorway even where the other side is no wider than itself, as a corridor is."""
LEAST_ROOM_M2 = 2.5
"""Less than this is a niche or a closet, and belongs to the room it opens to most."""


class FaceGraph:
    """Faces with what lies between them; merging changes it in place.

    `areas_m2`, `widths_m` (faces,): area, and width at the widest place, of each face; face 0 is
    what is not free.
    """

    def __init__(self, areas_m2: Array, widths_m: Array, borders: Mapping[Pair, Border]) -> None:
        self._area, self._width = areas_m2.copy(), widths_m.copy()
        self._parent = np.arange(len(areas_m2), dtype=np.int32)
        self._beside: list[dict[int, Border]] = [{} for _ in areas_m2]
        self._age = [0] * len(areas_m2)
        for (a, b), border in borders.items():
            self._beside[a][b] = self._beside[b][a] = border

    def merge_open(self) -> None:
        """Join what no wall and no doorway parts, the longest opening first."""
        queue: list[Offer] = []
        for a in range(len(self._area)):
            self._offer(queue, a, [b for b in self._beside[a] if a < b])
        while queue:
            _, a, b, age_a, age_b = heapq.heappop(queue)
            if (age_a, age_b) == (self._age[a], self._age[b]):
                self._join(a, b)
                self._offer(queue, a, self._beside[a])

    def absorb_niches(self) -> None:
        """Give what is too small for a room to its neighbour; without one, it is none."""
        while len(small := np.flatnonzero((self._area > 0) & (self._area < LEAST_ROOM_M2))):
            face = int(small[np.argmin(self._area[small])])
            opens = [(b.open_m, -other) for other, b in self._beside[face].items() if b.open_m > 0]
            self._join(-max(opens)[1] if opens else 0, face)
            self._area[0] = 0.0

    def rooms(self) -> Labels:
        """(faces,) label of the room that each face is of."""
        root = self._parent.copy()
        while (root != root[root]).any():
            root = root[root]
        return root

    def _offer(self, queue: list[Offer], face: int, others: Iterable[int]) -> None:
        for other in others:
            border = self._beside[face][other]
            a, b = min(face, other), max(face, other)
            if self._is_open(border, a, b):
                heapq.heappush(queue, (-border.open_m, a, b, self._age[a], self._age[b]))

    def _is_open(self, border: Border, a: int, b: int) -> bool:
        if border.open_m <= 0 or border.open_share < OPEN:
            return False
        is_door = border.open_m <= OF_WIDTH * max(self._width[a], self._width[b])
        return border.open_m > DOOR_M or not is_door

    def _join(self, kept: int, lost: int) -> None:
        for other, border in self._beside[lost].items():
            self._beside[other].pop(lost)
            if other == kept:
                continue
            if other in self._beside[kept]:
                self._beside[kept][other].join(border)
            else:
                self._beside[kept][other] = self._beside[other][kept] = border
        self._beside[lost] = {}
        self._parent[lost] = kept
        self._area[kept] += self._area[lost]
        self._width[kept] = max(self._width[kept], self._width[lost])
        self._area[lost] = 0.0
        self._age[kept] += 1
        self._age[lost] = -1
