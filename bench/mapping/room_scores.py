"""How well segments agree with true rooms, as the field measures it.

Precision and recall reward one segment for every room, or one room for every segment: of the first,
over-segmentation makes 1, of the second under-segmentation. The Matthews coefficient pairs them
one to one, and counts what is left over as 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Labels = NDArray[np.int32]
Counts = NDArray[np.int64]
Scores = dict[str, float]

LEAST_CELLS = 100
"""Smaller regions, drawn or found, are left out: so does Bormann's evaluation."""
MEASURES = ("precision", "recall", "mcc", "mcc_cells")


def scores(found: Labels, true: Labels) -> Scores:
    """Of segments and rooms (rows, cols), 0 = none: the measures and the numbers of both.

    - `precision`, `recall` (Bormann et al. 2016): means over segments and over rooms of the
      greatest overlap with any region of the other kind, by their own area.
    - `mcc` (Mielle et al. 2017): segments and rooms paired one to one, the greatest overlap first;
      mean of the pairs' Matthews coefficients, 0 for what has no partner. Only cells count that lie
      in both some segment and some room. `mcc_cells`: the coefficient of the cells of all pairs
      together.
    """
    overlap, own_found, own_true = _overlap(_without_small(found), _without_small(true))
    if not overlap.size:
        return {**dict.fromkeys(MEASURES, 0.0), "segments": len(own_found), "rooms": len(own_true)}
    quads = np.array(list(_confusions(overlap)), dtype=float)
    return {
        "precision": float((overlap.max(axis=1) / own_found).mean()),
        "recall": float((overlap.max(axis=0) / own_true).mean()),
        "mcc": float(np.mean([_matthews(*q) for q in quads])),
        "mcc_cells": _matthews(*quads.sum(axis=0)),
        "segments": len(own_found),
        "rooms": len(own_true),
    }


def regions(free: NDArray[np.bool_]) -> Labels:
    """(rows, cols) connected regions of free cells, corners included, from 1."""
    labels, _ = ndimage.label(free, structure=np.ones((3, 3)))
    return np.asarray(labels, dtype=np.int32)


def _without_small(labels: Labels) -> Labels:
    sizes = np.bincount(labels.ravel())
    kept = np.flatnonzero(sizes > LEAST_CELLS)
    renumbered = np.zeros(len(sizes), dtype=np.int32)
    renumbered[kept[kept > 0]] = np.arange(1, np.count_nonzero(kept) + 1)
    return renumbered[labels]


def _overlap(found: Labels, true: Labels) -> tuple[Counts, Counts, Counts]:
    """Cells (segments, rooms) that each pair shares, and the sizes of segments and of rooms."""
    shape = int(found.max()) + 1, int(true.max()) + 1
    both = np.bincount(np.ravel_multi_index((found.ravel(), true.ravel()), shape))
    table = np.pad(both, (0, math.prod(shape) - len(both))).reshape(shape)
    return table[1:, 1:], table[1:].sum(axis=1), table[:, 1:].sum(axis=0)


def _confusions(overlap: Counts) -> Iterator[tuple[float, float, float, float]]:
    """True and false positives, true and false negatives of each pair and of what has none."""
    total = float(overlap.sum())
    of_found, of_true = overlap.sum(axis=1), overlap.sum(axis=0)
    left = overlap.copy()
    free_found, free_true = set(range(len(of_found))), set(range(len(of_true)))
    while left.size and left.max() > 0:
        i, j = np.unravel_index(int(np.argmax(left)), left.shape)
        shared = float(overlap[i, j])
        wrong, missed = float(of_found[i]) - shared, float(of_true[j]) - shared
        yield shared, wrong, total - shared - wrong - missed, missed
        left[i, :], left[:, j] = 0, 0
        free_found.discard(int(i))
        free_true.discard(int(j))
    for i in free_found:
        yield 0.0, float(of_found[i]), total - float(of_found[i]), 0.0
    for j in free_true:
        yield 0.0, 0.0, total - float(of_true[j]), float(of_true[j])


def _matthews(tp: float, fp: float, tn: float, fn: float) -> float:
    """Matthews correlation coefficient; 0 without a true positive, 1 for one region that is all."""
    if tp == 0:
        return 0.0
    if tn == 0 and fp == 0 and fn == 0:
        return 1.0
    below = math.sqrt((tp + fp) * (tp + fn) * (tn + fp) * (tn + fn))
    return (tp * tn - fp * fn) / below if below else 0.0
