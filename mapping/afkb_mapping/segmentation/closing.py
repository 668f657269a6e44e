"""Which lines part rooms: those that the most wall stands beside, and then the next.

What lies beyond an opening that parts rooms is no wall's other face for another: of two doors side
by side, the corridor that they open to is not cut between them. As lines only lose by that, the
order is given by what stands: which of two rooms is larger, or was found first, decides nothing.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.segmentation.passages import flanks_m, passage_of, widest_m, width_m
from afkb_mapping.segmentation.wall_lines import Line, drawn

Mask = NDArray[np.bool_]
Clearance = NDArray[np.float32]

PASSAGE_M = 2.5
"""A wider opening is no passage but an open side: a double door with side lights is as wide."""
OPEN, OPEN_WIDE = 0.8, 0.7
"""A wall of which more is open, by a passage or by an open side, parts no rooms: in drawn plans
people cut openings of two thirds of a wall, and leave those of four fifths."""
SEEN = 0.5
"""A doorway that views have shown parts rooms if it is as likely as not."""
OF_WIDTH = 0.4
"""A corridor ends where its mouth is a passage no wider than this part of what it opens to."""


def closed_lines(
    free: Mask,
    clearance: Clearance,
    lines: Sequence[Line],
    likely: Sequence[float],
    resolution_m: float,
) -> Mask:
    """(rows, cols) cells on the lines of `free` that part rooms.

    `clearance` (rows, cols): distance to the nearest obstacle, m; `likely` (lines,): how far views
    have shown a doorway on each line, 0 to 1. Such a one may be wrong: it is no wall to others.
    """
    left, closed = free.copy(), np.zeros_like(free)

    def share(k: int) -> float | None:
        return _open_share(lines[k], left, clearance, resolution_m)

    for line, p in zip(lines, likely, strict=True):
        if p >= SEEN:
            closed |= drawn([line], free.shape)
    queue = [(s, k) for k in range(len(lines)) if (s := share(k)) is not None]
    heapq.heapify(queue)
    while queue:
        _, k = heapq.heappop(queue)
        now = share(k)
        if now is None:
            continue
        if queue and (now, k) > queue[0]:
            heapq.heappush(queue, (now, k))
            continue
        cells = drawn([lines[k]], free.shape)
        closed |= cells
        left &= ~cells
    return closed & free


def _open_share(line: Line, left: Mask, clearance: Clearance, resolution_m: float) -> float | None:
    """How much of the wall that a line lies in is open, 0 to 1; None where that parts no rooms."""
    passage = passage_of(line, left)
    if passage is None:
        return None
    width = width_m(passage, resolution_m)
    share = width / (width + flanks_m(passage, left, resolution_m))
    if share <= (OPEN if width <= PASSAGE_M else OPEN_WIDE):
        return share
    ends = width <= PASSAGE_M and width <= OF_WIDTH * widest_m(
        passage, left, clearance, resolution_m
    )
    return 1.0 if ends else None
