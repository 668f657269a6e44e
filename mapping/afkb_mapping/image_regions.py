"""Pixels of a labelled image, label by label."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

Rectangle = tuple[int, int, int, int]
BLIND_SHARE, BLIND_RETURNS = 0.06, 0.02
"""A blind border is at most this part of an image; wider ones are something that returns nothing,
as a window or a dark screen. Of its lines, strays aside, none returns."""


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """Pixels of one thing or surface in a depth image of `shape`, all arrays (N, …).

    Coordinates `u` (column) and `v` (row), depth in m, and points in the map frame. `returning`:
    the rectangle of pixels that can return (see `returning_rectangle`); None for all.
    """

    u: NDArray[np.int32]
    v: NDArray[np.int32]
    depth_m: NDArray[np.float32]
    points: NDArray[np.float64]
    shape: tuple[int, ...]
    returning: Rectangle | None = field(default=None, kw_only=True)

    @property
    def image_box(self) -> tuple[int, int, int, int]:
        """Half-open (u0, v0, u1, v1)."""
        return extent(self.u, self.v)

    @property
    def cut_by_image(self) -> bool:
        """Whether it reaches the edge of what the sensor can return."""
        return is_cut(self.image_box, self.returning or (0, 0, self.shape[1], self.shape[0]))


def is_cut(image_box: Rectangle, returning: Rectangle) -> bool:
    """Whether a box of pixels reaches the edge of the pixels that can return, to one pixel."""
    u0, v0, u1, v1 = returning
    left, top, right, bottom = image_box
    return left <= u0 + 1 or top <= v0 + 1 or right >= u1 - 1 or bottom >= v1 - 1


@kernel
def returning_rectangle(depth_m: NDArray[np.float32]) -> Rectangle:
    """The pixels (u0, v0, u1, v1), half-open, that the sensor can return at all.

    The matching windows of stereo and structured light leave a blind border, which ends what is
    seen no less than the image's edge does. It is told from one view: a margin, up to BLIND_SHARE
    of the image, in which all but BLIND_RETURNS of the rows (or columns) have nothing.
    """
    height, width = depth_m.shape
    most_u, most_v = int(BLIND_SHARE * width), int(BLIND_SHARE * height)
    left, right = np.zeros(most_u + 1, np.int64), np.zeros(most_u + 1, np.int64)
    top, bottom = np.zeros(most_v + 1, np.int64), np.zeros(most_v + 1, np.int64)
    for v in range(height):
        k = 0
        while k < most_u and not depth_m[v, k] > 0:
            k += 1
        left[k] += 1
        k = 0
        while k < most_u and not depth_m[v, width - 1 - k] > 0:
            k += 1
        right[k] += 1
    for u in range(width):
        k = 0
        while k < most_v and not depth_m[k, u] > 0:
            k += 1
        top[k] += 1
        k = 0
        while k < most_v and not depth_m[height - 1 - k, u] > 0:
            k += 1
        bottom[k] += 1
    u1, v1 = width - _blind(right, height), height - _blind(bottom, width)
    return _blind(left, height), _blind(top, width), u1, v1


@kernel
def _blind(begins: NDArray[np.int64], lines: int) -> int:
    """Width of a blind margin, px, from how many of its lines begin to return at each pixel."""
    begun = 0
    for k in range(len(begins)):
        begun += begins[k]
        if begun > BLIND_RETURNS * lines:
            return k if k < len(begins) - 1 else 0
    return 0


@kernel
def extent(u: NDArray[np.int32], v: NDArray[np.int32]) -> tuple[int, int, int, int]:
    """Half-open box (u0, v0, u1, v1) around pixels (N,), N > 0."""
    u0 = u1 = u[0]
    v0 = v1 = v[0]
    for k in range(1, len(u)):
        u0, u1 = min(u0, u[k]), max(u1, u[k])
        v0, v1 = min(v0, v[k]), max(v1, v[k])
    return u0, v0, u1 + 1, v1 + 1


@kernel
def pixels_by_label(
    labels: NDArray[np.signedinteger], wanted: NDArray[np.bool_], thin: NDArray[np.int64]
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int64]]:
    """Columns u and rows v of the wanted labels' pixels, label by label, and where each begins.

    `labels` (H, W); of those above 0, label k holds `u[starts[k]:starts[k + 1]]`, in the order
    of the image. `thin` (n_labels,): of a label, every such row and column alone is taken.
    """
    runs, count = _runs_of_labels(labels, wanted)
    starts = np.zeros(len(wanted) + 1, np.int64)
    for r in range(count):
        k = runs[r, 0]
        starts[k + 1] += _count_taken(runs[r], thin[k])
    for k in range(len(wanted)):
        starts[k + 1] += starts[k]
    u, v = np.empty(starts[-1], np.int32), np.empty(starts[-1], np.int32)
    fill = starts[:-1].copy()
    for r in range(count):
        k, i, first, last = runs[r]
        n = fill[k]
        fill[k] += _count_taken(runs[r], thin[k])
        if i % thin[k] == 0:
            for j in range((first + thin[k] - 1) // thin[k] * thin[k], last, thin[k]):
                u[n], v[n] = j, i
                n += 1
    return u, v, starts


@kernel
def _count_taken(run: NDArray[np.int32], thin: int) -> int:
    """How many pixels of a run are taken."""
    if run[1] % thin != 0:
        return 0
    return int((run[3] + thin - 1) // thin - (run[2] + thin - 1) // thin)


@kernel
def _runs_of_labels(
    labels: NDArray[np.signedinteger], wanted: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], int]:
    """Runs of wanted labels along rows, as (label, row, first, last + 1), and their number."""
    rows, cols = labels.shape
    runs, count = np.empty((labels.size, 4), np.int32), 0
    for i in range(rows):
        j = 0
        while j < cols:
            k, first = labels[i, j], j
            j += 1
            while j < cols and labels[i, j] == k:
                j += 1
            if k > 0 and wanted[k]:
                runs[count, 0], runs[count, 1], runs[count, 2], runs[count, 3] = k, i, first, j
                count += 1
    return runs, count


@kernel
def order_by_label(
    labels: NDArray[np.signedinteger], wanted: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indexes of the entries of `labels` (N,) that are wanted, label by label, and their starts.

    Label k holds `order[starts[k]:starts[k + 1]]`, ascending.
    """
    n, last = len(wanted), len(labels)
    starts = np.zeros(n + 1, np.int64)
    i = 0
    while i < last:
        k, first = labels[i], i
        while i < last and labels[i] == k:
            i += 1
        if wanted[k]:
            starts[k + 1] += i - first
    for k in range(n):
        starts[k + 1] += starts[k]
    order, fill = np.empty(starts[n], np.int64), starts[:-1].copy()
    i = 0
    while i < last:
        k, first = labels[i], i
        while i < last and labels[i] == k:
            i += 1
        if wanted[k]:
            for j in range(first, i):
                order[fill[k] + j - first] = j
            fill[k] += i - first
    return order, starts
