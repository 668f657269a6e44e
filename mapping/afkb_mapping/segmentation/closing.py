"""Which lines part rooms, decided from the narrowest opening to the widest.

What lies beyond a narrow opening is no wall's other face for a wider one: of two doors side by side
the corridor that they open to is not cut between them. Hence the order, and hence none other: which
of two rooms is larger, or was found first, decides nothing.
"""

from __future__ import annotations

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
    have shown a doorway on each line, 0 to 1; so far its opening counts as a wall.
    """
    left, closed = free.copy(), np.zeros_like(free)
    lengths = [float(np.linalg.norm(line[-1] - line[0])) for line in lines]
    for k in np.argsort(lengths, kind="stable"):
        passage = passage_of(lines[k], left)
        if passage is None:
            continue
        width = width_m(passage, resolution_m)
        wall = flanks_m(passage, left, resolution_m)
        open_share = (1 - likely[k]) * width / (width + wall)
        parts = open_share <= (OPEN if width <= PASSAGE_M else OPEN_WIDE)
        if not parts and width <= PASSAGE_M:
            parts = width <= OF_WIDTH * widest_m(passage, free, clearance, resolution_m)
        if parts:
            closed |= drawn([lines[k]], free.shape)
            left &= ~closed
    return closed & free
