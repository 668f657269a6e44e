"""A view's surfaces as an image of labels, of cells or of pixels: the same to all that read it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.image_regions import Rectangle
from afkb_mapping.kernels import kernel
from afkb_surfaces.cells import COUNT, DEPTH, Cells
from afkb_surfaces.pixels import pixel_labels


@dataclass(frozen=True, slots=True, eq=False)
class Labelled:
    """An image of labels (H, W), with the depth that goes with it and the camera that sees it so.

    - `size_px`: pixels of the depth image along one of its own. `intrinsics`: fx, fy, cx, cy in
      its own. `returning`: the part of it in which the sensor can return.
    - `border`: cells of `cell` of its own pixels in which a surface's border may lie; `near`: those
      in which there is any of it.
    """

    labels: NDArray[np.int32]
    depth_m: NDArray[np.float32]
    intrinsics: NDArray[np.float64]
    returning: Rectangle
    border: NDArray[np.bool_]
    near: NDArray[np.bool_]
    cell: int
    size_px: int

    @classmethod
    def of_cells(
        cls,
        cells: Cells,
        labels: NDArray[np.int32],
        intrinsics: NDArray[np.float64],
        returning: Rectangle,
    ) -> Labelled:
        """An image of a pixel a cell."""
        size, planes = cells.size_px, cells.planes
        fx, fy, cx, cy = intrinsics
        middle = (size - 1) / 2
        smaller = np.array([fx / size, fy / size, (cx - middle) / size, (cy - middle) / size])
        u0, v0, u1, v1 = returning
        whole = (-(-u0 // size), -(-v0 // size), u1 // size, v1 // size)
        everywhere = np.ones(labels.shape, np.bool_)
        return cls(labels, _cell_depths(planes), smaller, whole, everywhere, everywhere, 1, size)

    @classmethod
    def of_pixels(
        cls,
        depth_m: NDArray[np.float32],
        cells: Cells,
        labels: NDArray[np.int32],
        wanted: NDArray[np.bool_],
        intrinsics: NDArray[np.float64],
        returning: Rectangle,
        softness_m: float,
    ) -> Labelled:
        """The depth image itself, the wanted labels (n_labels,) settled to the pixel."""
        strays = (cells.noise, softness_m)
        size = cells.size_px
        out, border, near = pixel_labels(depth_m, cells.planes, labels, wanted, size, strays)
        return cls(out, depth_m, intrinsics, returning, border, near, size, 1)


@kernel
def runs_by_label(
    labels: NDArray[np.int32], near: NDArray[np.bool_], cell: int, wanted: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Runs of wanted labels along rows, label by label, as (v, first u, last u + 1): (n, 3).

    Those of label k are `runs[starts[k]:starts[k + 1]]`, in the order of the image. Nothing wanted
    lies outside of the `near` cells (rows, cols) of `cell` pixels.
    """
    rows, cols = near.shape
    found, count = np.empty((np.count_nonzero(near) * cell * cell, 4), np.int32), 0
    starts = np.zeros(len(wanted) + 1, np.int64)
    spans = np.empty((cols, 2), np.int32)
    for r in range(rows):
        n_spans = _spans_of(near[r], cell, spans)
        for v in range(r * cell, (r + 1) * cell):
            line = labels[v]
            for n in range(n_spans):
                u, end = spans[n, 0], spans[n, 1]
                while u < end:
                    k, first = line[u], u
                    while u < end and line[u] == k:
                        u += 1
                    if wanted[k]:
                        found[count, 0], found[count, 1] = k, v
                        found[count, 2], found[count, 3] = first, u
                        starts[k + 1] += 1
                        count += 1
    for n in range(len(wanted)):
        starts[n + 1] += starts[n]
    runs, fill = np.empty((count, 3), np.int32), starts[:-1].copy()
    for n in range(count):
        at = fill[found[n, 0]]
        fill[found[n, 0]] += 1
        runs[at, 0], runs[at, 1], runs[at, 2] = found[n, 1], found[n, 2], found[n, 3]
    return runs, starts


@kernel
def _spans_of(near: NDArray[np.bool_], cell: int, spans: NDArray[np.int32]) -> int:
    """Writes from where to where, in pixels, the near cells of a row reach; how many spans."""
    c = n = 0
    while c < len(near):
        first = c
        while c < len(near) and near[c]:
            c += 1
        if c > first:
            spans[n, 0], spans[n, 1] = first * cell, c * cell
            n += 1
        c += 1
    return n


@kernel
def members_of(
    runs: NDArray[np.int32], width: int
) -> tuple[NDArray[np.int32], tuple[int, int, int, int]]:
    """Flat indexes (N,) of the pixels of runs (n, 3), n > 0, in an image, and the box around."""
    total, left, right = 0, runs[0, 1], runs[0, 2]
    for n in range(len(runs)):
        total += runs[n, 2] - runs[n, 1]
        left, right = min(left, runs[n, 1]), max(right, runs[n, 2])
    out, i = np.empty(total, np.int32), 0
    for n in range(len(runs)):
        start = runs[n, 0] * width
        for u in range(runs[n, 1], runs[n, 2]):
            out[i] = start + u
            i += 1
    return out, (left, runs[0, 0], right, runs[-1, 0] + 1)


@kernel
def pixels_of(
    members: NDArray[np.int32], cols: int, size_px: int, depth_m: NDArray[np.float32]
) -> NDArray[np.int32]:
    """Flat indexes of the pixels with depth in cells, which are members of an image of `cols`."""
    width = depth_m.shape[1]
    out, n = np.empty(len(members) * size_px * size_px + 1, np.int32), 0
    for k in range(len(members)):
        i, j = members[k] // cols, members[k] % cols
        for v in range(i * size_px, (i + 1) * size_px):
            for u in range(j * size_px, (j + 1) * size_px):
                out[n] = v * width + u
                n += depth_m[v, u] > 0
    return out[:n].copy()


@kernel
def _cell_depths(planes: NDArray[np.float32]) -> NDArray[np.float32]:
    """Depth of each cell (rows, cols), 0 where none has a plane."""
    out = np.empty((planes.shape[0], planes.shape[2]), np.float32)
    for r in range(out.shape[0]):
        depth, count, row = planes[r, DEPTH], planes[r, COUNT], out[r]
        for c in range(out.shape[1]):
            row[c] = depth[c] if count[c] > np.float32(0) else np.float32(0)
    return out
