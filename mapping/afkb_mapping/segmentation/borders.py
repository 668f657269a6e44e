"""What lies between two faces of free space: how much of their border is open, how much is wall."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Labels = NDArray[np.int32]
Shares = NDArray[np.float32]

HALF_WALL_M = 0.3
"""What lies on either side of a wall twice as thick, or thinner, is beside each other."""
STEPS = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, math.sqrt(0.5)), (1, -1, math.sqrt(0.5)))
"""Rows and columns to the neighbours, and how far apart lines in that direction lie, in cells."""
CROFTON = math.pi / 8
"""Length of a curve by how often lines in these four directions cross it (Cauchy and Crofton)."""


@dataclass(slots=True)
class Border:
    """Between two faces: m over which it is open, and over which a wall stands."""

    open_m: float = 0.0
    walled_m: float = 0.0

    @property
    def open_share(self) -> float:
        """How much of it is open, 0 to 1."""
        return self.open_m / max(self.open_m + self.walled_m, 1e-9)

    def join(self, other: Border) -> None:
        """Add another one's lengths."""
        self.open_m += other.open_m
        self.walled_m += other.walled_m


def borders(faces: Labels, closed: Shares, resolution_m: float) -> dict[tuple[int, int], Border]:
    """Borders by pair of faces, the smaller label first.

    - `faces` (rows, cols): 0 = not free.
    - `closed` (rows, cols): how far a border through a free cell counts as a wall, 0 to 1.
    """
    distance, cells = ndimage.distance_transform_edt(faces == 0, return_indices=True)
    grown = np.where(distance * resolution_m <= HALF_WALL_M, faces[tuple(cells)], 0)
    n = int(faces.max()) + 1
    found: dict[tuple[int, int], Border] = {}
    for dr, dc, spacing in STEPS:
        here, there = _shifted(faces.shape, dr, dc)
        a, b = grown[here], grown[there]
        meet = (a != b) & (a > 0) & (b > 0)
        free = ((faces[here] > 0) & (faces[there] > 0))[meet]
        wall = np.where(free, np.maximum(closed[here], closed[there])[meet], 1.0)
        low, high = np.minimum(a, b)[meet].astype(np.int64), np.maximum(a, b)[meet]
        pairs, which = np.unique(low * n + high, return_inverse=True)
        scale = CROFTON * spacing * resolution_m
        walled = np.bincount(which, wall, len(pairs)) * scale
        both = np.bincount(which, minlength=len(pairs)) * scale
        for pair, w, length in zip(pairs.tolist(), walled.tolist(), both.tolist(), strict=True):
            found.setdefault(divmod(pair, n), Border()).join(Border(length - w, w))
    return found


def _shifted(
    shape: tuple[int, ...], dr: int, dc: int
) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Windows of cells and of their neighbours so many rows and columns on."""
    rows, cols = shape
    here = np.s_[: rows - dr, max(0, -dc) : cols - max(0, dc)]
    there = np.s_[dr:, max(0, dc) : cols + min(0, dc)]
    return here, there
