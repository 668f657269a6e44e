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

from afkb_mapping.segmentation.passages import (
    FLANK_M,
    Passage,
    flanks_m,
    passage_of,
    widest_m,
    width_m,
)
from afkb_mapping.segmentation.wall_lines import Line, drawn

Mask = NDArray[np.bool_]
Clearance = NDArray[np.float32]

PASSAGE_M = 2.5
"""A wider opening is no passage but an open side: a double door with side lights is as wide."""
OPEN, OPEN_WIDE = 0.8, 0.7
"""A wall of which more is open, by a passage or by an open side, parts no rooms: in drawn plans
people cut openings of two thirds of a wall, and leave those of four fifths."""
NARROWER, ACROSS = 0.85, 0.7
"""An opening so much narrower, in a wall that stands across (cosine), is a door to what lies behind
it: of doors side by side, on both sides of a corridor, these part rooms, and not it."""
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
    for line, p in zip(lines, likely, strict=True):
        if p >= SEEN:
            closed |= drawn([line], free.shape)
    openings = [_opening(line, free, clearance, resolution_m) for line in lines]
    rivals = [_rivals(opening, openings, resolution_m) for opening in openings]
    rest: Sequence[int] = range(len(lines))
    none: list[list[int]] = [[] for _ in lines]
    for doors in (rivals, none):
        rest = _close(rest, lines, doors, left, closed, clearance, resolution_m)
    return closed & free


def _close(
    which: Sequence[int],
    lines: Sequence[Line],
    doors: Sequence[Sequence[int]],
    left: Mask,
    closed: Mask,
    clearance: Clearance,
    resolution_m: float,
) -> list[int]:
    """Close lines in `closed`, and take them out of `left`; those that stay open are given back.

    `doors` (lines,): indices of those that are doors in walls across each.
    """

    def share(k: int) -> float | None:
        behind = left & ~drawn([lines[j] for j in doors[k]], left.shape) if doors[k] else left
        return _open_share(lines[k], left, behind, clearance, resolution_m)

    queue = [(s, k) for k in which if (s := share(k)) is not None]
    heapq.heapify(queue)
    done = set()
    while queue:
        _, k = heapq.heappop(queue)
        now = share(k)
        if now is None:
            continue
        if queue and (now, k) > queue[0]:
            heapq.heappush(queue, (now, k))
            continue
        cells = drawn([lines[k]], left.shape)
        closed |= cells
        left &= ~cells
        done.add(k)
    return [k for k in which if k not in done]


def _opening(line: Line, free: Mask, clearance: Clearance, resolution_m: float) -> Passage | None:
    """What a line opens, if it might part rooms."""
    if _open_share(line, free, free, clearance, resolution_m) is None:
        return None
    return passage_of(line, free)


def _rivals(
    opening: Passage | None, others: Sequence[Passage | None], resolution_m: float
) -> list[int]:
    """Openings so much narrower, in walls that stand across, that one may take for its flanks."""
    if opening is None:
        return []
    width = width_m(opening, resolution_m)
    return [
        j
        for j, other in enumerate(others)
        if other is not None
        and width_m(other, resolution_m) < NARROWER * width
        and abs(float(other.along @ opening.along)) < ACROSS
        and float(np.linalg.norm(other.middle - opening.middle)) * resolution_m < width + FLANK_M
    ]


def _open_share(
    line: Line, left: Mask, behind: Mask, clearance: Clearance, resolution_m: float
) -> float | None:
    """How much of the wall that a line lies in is open, 0 to 1; None where that parts no rooms.

    `behind`: the cells of `left` but for those in doors of walls that stand across.
    """
    passage = passage_of(line, left)
    if passage is None:
        return None
    width = width_m(passage, resolution_m)
    share = width / (width + flanks_m(passage, left, behind, resolution_m))
    if share <= (OPEN if width <= PASSAGE_M else OPEN_WIDE):
        return share
    ends = width <= PASSAGE_M and width <= OF_WIDTH * widest_m(
        passage, left, clearance, resolution_m
    )
    return 1.0 if ends else None
