"""Parts of an open plan: where affordances tell of two purposes, a room is divided (paper §II.F).

Of one room, all parts have one purpose; of two rooms, each has its own. With the posteriors p and q
of two parts over purposes r of prior P(r), the Bayes factor of two rooms over one is

    1 / sum of p(r) q(r) / P(r):

1 where either part tells nothing, P(r) where both are surely of purpose r, and without bound where
they contradict each other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb_mapping.segmentation.spreading import spread
from afkb_mapping.segmentation.wall_lines import Line, drawn

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]
Belief = Mapping[str, float]
Purpose = Callable[[Mask], Belief | None]
"""Posterior over purposes of a part (rows, cols) of the grid, by what is in it; None if nothing."""

SUBSTANTIAL = 10**0.5
"""A Bayes factor from which evidence is called substantial (Jeffreys 1961)."""
MOST_LINES = 16
"""The narrowest lines of a room that are looked at, and pairs of them."""
LEAST_PART_M2 = 4.0
"""A smaller part is a corner of a room, whatever stands in it."""


def bayes_factor(first: Belief, second: Belief, prior: Belief) -> float:
    """Of two rooms over one, by the posteriors of both parts."""
    same = sum(first[r] * second[r] / prior[r] for r in prior if prior[r] > 0)
    return 1 / same if same > 0 else math.inf


def divided(
    labels: Labels, lines: Sequence[Line], purpose: Purpose, prior: Belief, resolution_m: float
) -> Labels:
    """Labels with rooms divided in two, and again, along the narrowest line that parts purposes."""
    labels = labels.copy()
    left = list(range(1, int(labels.max()) + 1))
    while left:
        room = left.pop()
        part = _other_purpose(labels == room, lines, purpose, prior, resolution_m)
        if part is not None:
            new = int(labels.max()) + 1
            labels[part] = new
            left += [room, new]
    return labels


def _other_purpose(
    room: Mask, lines: Sequence[Line], purpose: Purpose, prior: Belief, resolution_m: float
) -> Mask | None:
    """The part of a room beyond its narrowest line across which purposes differ, or None."""
    least = 2 * LEAST_PART_M2 / resolution_m**2
    if room.sum() < least or purpose(room) is None:
        return None
    for part in _parts(room, lines, least / 2):
        first, second = purpose(part), purpose(room & ~part)
        if first and second and bayes_factor(first, second, prior) >= SUBSTANTIAL:
            return part
    return None


def _parts(room: Mask, lines: Sequence[Line], least_cells: float) -> Iterator[Mask]:
    """One part beyond each line, or pair of lines, that divides a room; the narrowest first."""
    rows, cols = np.nonzero(room)
    window = np.s_[rows.min() : rows.max() + 1, cols.min() : cols.max() + 1]
    inside = room[window]
    for cut in _cuts(inside, lines, np.array([cols.min(), rows.min()])):
        pieces, count = ndimage.label(inside & ~cut)
        sizes = np.bincount(pieces.ravel(), minlength=count + 1)
        sizes[0] = 0
        large = np.flatnonzero(sizes >= least_cells)
        if len(large) == 2:
            cores = np.where(np.isin(pieces, large), pieces, 0).astype(np.int32)
            part = np.zeros_like(room)
            part[window] = spread(cores, inside) == large[0]
            yield part


def _cuts(inside: Mask, lines: Sequence[Line], corner: NDArray[np.intp]) -> list[Mask]:
    """Cells of a room on each line that crosses it and on each two, the fewest first.

    Around what stands free in a room, a wall or a shelf, two lines part it.
    """
    moved = [line - corner for line in lines]
    size = inside.shape[::-1]
    near = [m for m in moved if (m.max(axis=0) >= 0).all() and (m.min(axis=0) < size).all()]
    cells = {c.tobytes(): c for m in near if (c := drawn([m], inside.shape) & inside).any()}
    single = sorted(cells.values(), key=np.count_nonzero)[:MOST_LINES]
    return sorted([*single, *(a | b for a, b in combinations(single, 2))], key=np.count_nonzero)
