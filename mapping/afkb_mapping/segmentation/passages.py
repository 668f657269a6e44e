"""How wide a line's opening is, and how far walls go on from it with rooms on both sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.segmentation.wall_lines import Line

Mask = NDArray[np.bool_]
Array = NDArray[np.float64]
Clearance = NDArray[np.float32]

BESIDE_M = (0.1, 0.6)
"""How far off its line what goes on beside an opening is looked for: walls are as thick at most."""
BESIDE_STEP_M = 0.05
FLANK_M = 2.0
"""Walls are followed no further: no more of them is needed to part rooms."""
AHEAD_M = 4.0
"""How far ahead of an opening the width of what it leads to is looked for."""


@dataclass(frozen=True, slots=True)
class Passage:
    """A straight way across free space, from jamb to jamb.

    `start`, `end`: (2,) column and row of its first and last free cell; `along`: unit vector from
    the one to the other.
    """

    start: Array
    end: Array
    along: Array

    @property
    def middle(self) -> Array:
        """(2,) column and row."""
        middle: Array = (self.start + self.end) / 2
        return middle

    @property
    def normal(self) -> Array:
        """(2,) unit vector to one of its sides."""
        return np.array([-self.along[1], self.along[0]])


def passage_of(line: Line, free: Mask) -> Passage | None:
    """What a line opens between its ends; None where no cell of it is free."""
    first, last = line[0].astype(np.float64), line[-1].astype(np.float64)
    length = float(np.linalg.norm(last - first))
    if length < 1:
        return None
    along = (last - first) / length
    steps = np.arange(0, length + 0.5, 0.5)
    on = np.flatnonzero(_marked(free, first + steps[:, None] * along))
    if not len(on):
        return None
    return Passage(first + steps[on[0]] * along, first + steps[on[-1]] * along, along)


def width_m(passage: Passage, resolution_m: float) -> float:
    """From jamb to jamb, m."""
    return (float(np.linalg.norm(passage.end - passage.start)) + 1) * resolution_m


def flanks_m(passage: Passage, free: Mask, behind: Mask, resolution_m: float) -> float:
    """Length of the walls in line with a passage that have free space along both faces, m.

    Both ends together. A room's door has such walls; the mouth of a corridor has none, as the
    corridor is no wider than its mouth. `behind`: the free cells without those that doors in other
    walls lead to. One face may be looked for behind such doors, but not both.
    """
    beside = np.arange(BESIDE_M[0], BESIDE_M[1] + BESIDE_STEP_M / 2, BESIDE_STEP_M) / resolution_m
    total = 0.0
    for jamb, outward in ((passage.start, -passage.along), (passage.end, passage.along)):
        inner = jamb - outward
        through, around = (
            [
                _free_run(inner, outward, side, beside, cells, resolution_m)
                for side in (passage.normal, -passage.normal)
            ]
            for cells in (free, behind)
        )
        total += min(*through, max(around))
    return total * resolution_m


def widest_m(passage: Passage, free: Mask, clearance: Clearance, resolution_m: float) -> float:
    """Width of the wider of the two places that a passage leads to, m.

    `clearance` (rows, cols): distance to the nearest obstacle, m.
    """
    ahead = np.arange(AHEAD_M / resolution_m)[:, None]
    widths = []
    for side in (passage.normal, -passage.normal):
        points = passage.middle + ahead * side
        reached = int(np.logical_and.accumulate(_marked(free, points)).sum())
        cols, rows = _cells(points[:reached]).T
        widths.append(2 * float(clearance[rows, cols].max(initial=0.0)))
    return max(widths)


def _free_run(
    inner: Array, outward: Array, side: Array, beside: Array, free: Mask, resolution_m: float
) -> float:
    """Cells that free space beside a line goes on beyond its jamb, where it goes furthest.

    `inner`: (2,) a free cell of the line, one before the jamb; only what is free from there on to
    the `side` counts.
    """
    off = np.arange(0, beside[-1] + 0.5, 0.5)
    reached = np.logical_and.accumulate(_marked(free, inner + off[:, None] * side))
    from_line = reached[np.minimum((beside / 0.5).astype(int), len(off) - 1)]
    run = np.arange(FLANK_M / resolution_m + 2)
    points = inner + beside[:, None, None] * side + run[None, :, None] * outward
    lengths = np.logical_and.accumulate(_marked(free, points), axis=1).sum(axis=1) * from_line
    return max(0.0, float(lengths.max()) - 2)


def _marked(mask: Mask, points: Array) -> Mask:
    """Whether the cells at points (..., 2), column and row, are marked; off the grid none is."""
    cells = _cells(points)
    inside: Mask = np.all((cells >= 0) & (cells < mask.shape[::-1]), axis=-1)
    cells = np.where(inside[..., None], cells, 0)
    marked: Mask = mask[cells[..., 1], cells[..., 0]] & inside
    return marked


def _cells(points: Array) -> NDArray[np.intp]:
    return np.floor(points + 0.5).astype(np.intp)
