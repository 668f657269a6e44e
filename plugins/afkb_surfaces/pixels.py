"""Borders of surfaces to the pixel: cells whose neighbours disagree are settled pixel by pixel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.cells import DEPTH, A, B, C

REACH = 2.5
"""A pixel lies on a plane if it strays from it by at most this many times the noise."""
RING = np.array(
    [[0, 0], [0, 1], [1, 0], [0, -1], [-1, 0], [1, 1], [1, -1], [-1, 1], [-1, -1]], np.int64
)
"""A cell and those around it, nearest first."""


@kernel
def pixel_labels(
    depth_m: NDArray[np.float32],
    planes: NDArray[np.float32],
    labels: NDArray[np.int32],
    wanted: NDArray[np.bool_],
    size_px: int,
    strays_m: tuple[float, float],
) -> tuple[NDArray[np.int32], NDArray[np.bool_], NDArray[np.bool_]]:
    """Label (H, W) of each pixel that lies on its cell's plane or on one next to it; border cells.

    Only what lies within a cell of a `wanted` label (n_labels,) is labelled. Cells in the midst of
    a surface are taken whole: their planes were found flat. The cells (rows, cols) at a border of
    a wanted label, the image's edge included, are told besides, and so are all within a cell of
    one. `strays_m`: noise, as a multiple
    of `depth_sigma`, and softness by which pixels stray.
    """
    rows, cols = labels.shape
    out = np.zeros(depth_m.shape, np.int32)
    border = np.zeros((rows, cols), np.bool_)
    around, names = np.empty((9, 4), np.float32), np.empty(9, np.int32)
    inside, near = np.zeros(cols, np.bool_), _near_wanted(labels, wanted)
    for r in range(rows):
        if 0 < r < rows - 1:
            _find_inside(labels[r - 1], labels[r], labels[r + 1], inside)
        else:
            inside[:] = False
        for c in range(cols):
            if not near[r, c]:
                continue
            if inside[c]:
                _take_whole(depth_m, out, r * size_px, c * size_px, size_px, labels[r, c])
            else:
                border[r, c] = True
                n = _planes_around(r, c, planes, labels, strays_m, around, names)
                own = names[0] if labels[r, c] > 0 else -1
                _settle(depth_m, out, r * size_px, c * size_px, size_px, around, names[:n], own)
    return out, border, near


@kernel
def _near_wanted(labels: NDArray[np.int32], wanted: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells (rows, cols) that have a wanted label within one cell."""
    rows, cols = labels.shape
    across = np.zeros((rows + 2, cols), np.bool_)
    row = np.zeros(cols + 2, np.bool_)
    for r in range(rows):
        for c in range(cols):
            row[c + 1] = wanted[labels[r, c]]
        out = across[r + 1]
        for c in range(cols):
            out[c] = row[c] | row[c + 1] | row[c + 2]
    near = np.empty((rows, cols), np.bool_)
    for r in range(rows):
        above, here, below, out = across[r], across[r + 1], across[r + 2], near[r]
        for c in range(cols):
            out[c] = above[c] | here[c] | below[c]
    return near


@kernel
def _find_inside(
    above: NDArray[np.int32],
    here: NDArray[np.int32],
    below: NDArray[np.int32],
    inside: NDArray[np.bool_],
) -> None:
    """Of a row of cells, those that have one label, or none, with all around them."""
    for c in range(1, len(here) - 1):
        k = here[c]
        same = (above[c - 1] == k) & (above[c] == k) & (above[c + 1] == k)
        same &= (here[c - 1] == k) & (here[c + 1] == k)
        inside[c] = same & (below[c - 1] == k) & (below[c] == k) & (below[c + 1] == k)


@kernel
def _take_whole(
    depth_m: NDArray[np.float32], out: NDArray[np.int32], v0: int, u0: int, size: int, label: int
) -> None:
    for v in range(v0, v0 + size):
        for u in range(u0, u0 + size):
            out[v, u] = label if depth_m[v, u] > np.float32(0) else 0


@kernel
def _planes_around(
    r: int,
    c: int,
    planes: NDArray[np.float32],
    labels: NDArray[np.int32],
    strays_m: tuple[float, float],
    around: NDArray[np.float32],
    names: NDArray[np.int32],
) -> int:
    """How many surfaces there are within one cell.

    Writes the nearest plane of each, by how much 1/z strays from it, and its label.
    """
    n, last = 0, np.int32(0)
    for k in range(9):
        i, j = r + RING[k, 0], c + RING[k, 1]
        if not (0 <= i < labels.shape[0] and 0 <= j < labels.shape[1]):
            continue
        name = labels[i, j]
        known = (name == 0) | (name == last)
        for m in range(n):
            known |= names[m] == name
        if not known:
            z = planes[i, DEPTH, j]
            around[n, 0], around[n, 1] = planes[i, A, j], planes[i, B, j]
            around[n, 2], names[n], last = planes[i, C, j], name, name
            around[n, 3] = (REACH * strays_m[0] * depth_sigma(z) + strays_m[1]) / (z * z)
            n += 1
    return n


@kernel
def _settle(
    depth_m: NDArray[np.float32],
    out: NDArray[np.int32],
    v0: int,
    u0: int,
    size: int,
    around: NDArray[np.float32],
    names: NDArray[np.int32],
    own: int,
) -> None:
    """Give each pixel of a cell to the plane that it is nearest to, if it lies on any.

    The cell's own plane, if it has one, comes first where the pixel lies on it.
    """
    for v in range(v0, v0 + size):
        for u in range(u0, u0 + size):
            z = depth_m[v, u]
            best, name, settled = np.float32(np.inf), np.int32(0), False
            # a pixel without depth lies on none: it is 1 off, of which 0 is allowed
            for k in range(len(names)):
                at = around[k, 0] * np.float32(u) + around[k, 1] * np.float32(v) + around[k, 2]
                off = abs(at * z - np.float32(1))
                nearer = (off < min(best, around[k, 3] * z)) & (not settled)
                best = off if nearer else best
                name = names[k] if nearer else name
                settled |= nearer & (names[k] == own)
            out[v, u] = name
