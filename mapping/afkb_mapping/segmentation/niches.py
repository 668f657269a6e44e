"""What is too small for a room belongs to the one that it opens to most."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]
Array = NDArray[np.float64]

LEAST_ROOM_M2 = 2.5
"""Less than this is a niche, and belongs to the room it opens to most,"""
LEAST_CLOSET_M2 = 1.0
"""unless it is behind a doorway that views have shown: so large is the smallest bathroom."""
BEHIND_DOOR = 0.5
"""It is behind one where that makes up so much of what it opens by."""
STEPS = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, math.sqrt(0.5)), (1, -1, math.sqrt(0.5)))
"""Rows and columns to the neighbours, and how far apart lines in that direction lie, in cells."""
CROFTON = math.pi / 8
"""Length of a curve by how often lines in these four directions cross it (Cauchy and Crofton)."""


def without_niches(parts: Labels, doors: Mask, resolution_m: float) -> Labels:
    """(rows, cols) label of the room of each cell; the smallest niche goes first.

    `doors` (rows, cols): cells on doorways that views have shown. A niche that opens to nothing is
    no room.
    """
    areas: Array = np.bincount(parts.ravel()).astype(np.float64) * resolution_m**2
    areas[0] = 0.0
    opens = contacts_m(parts, resolution_m)
    by_door = contacts_m(parts, resolution_m, doors)
    share = by_door.sum(axis=1) / np.maximum(opens.sum(axis=1), 1e-9)
    least = np.where(share >= BEHIND_DOOR, LEAST_CLOSET_M2, LEAST_ROOM_M2)
    heirs = np.arange(len(areas), dtype=np.int32)
    while len(small := np.flatnonzero((areas > 0) & (areas < least))):
        niche = int(small[np.argmin(areas[small])])
        heir = int(np.argmax(opens[niche])) if opens[niche].any() else 0
        heirs[niche] = heir
        areas[heir] += areas[niche]
        areas[niche] = areas[0] = 0.0
        opens[heir] += opens[niche]
        opens[:, heir] += opens[:, niche]
        opens[niche] = opens[:, niche] = opens[heir, heir] = 0.0
    while (heirs != heirs[heirs]).any():
        heirs = heirs[heirs]
    return heirs[parts]


def contacts_m(parts: Labels, resolution_m: float, on: Mask | None = None) -> Array:
    """(parts + 1, parts + 1) length over which parts touch, m; of `on` (rows, cols) alone if given.

    Label 0 touches nothing.
    """
    count = int(parts.max()) + 1
    lengths = np.zeros(count * count)
    for dr, dc, spacing in STEPS:
        here, there = _shifted(parts.shape, dr, dc)
        a, b = parts[here], parts[there]
        meet = (a != b) & (a > 0) & (b > 0)
        if on is not None:
            meet &= on[here] | on[there]
        pairs = a[meet].astype(np.int64) * count + b[meet]
        lengths += np.bincount(pairs, minlength=count * count) * CROFTON * spacing * resolution_m
    touching = lengths.reshape(count, count)
    return touching + touching.T


def _shifted(
    shape: tuple[int, ...], dr: int, dc: int
) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Windows of cells and of their neighbours so many rows and columns on."""
    rows, cols = shape
    here = np.s_[: rows - dr, max(0, -dc) : cols - max(0, dc)]
    there = np.s_[dr:, max(0, dc) : cols + min(0, dc)]
    return here, there
