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
    - `border`: cells of `cell` of its own pixels in which a surface's border may lie.
    """

    labels: NDArray[np.int32]
    depth_m: NDArray[np.float32]
    intrinsics: NDArray[np.float64]
    returning: Rectangle
    border: NDArray[np.bool_]
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
        return cls(labels, _cell_depths(planes), smaller, whole, everywhere, 1, size)

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
        out, border = pixel_labels(depth_m, cells.planes, labels, wanted, cells.size_px, strays)
        return cls(out, depth_m, intrinsics, returning, border, cells.size_px, 1)

    def box_of(self, cell_box: tuple[int, int, int, int], size_px: int) -> Rectangle:
        """Half-open box in its own pixels around a box of cells of `size_px`, and one more."""
        scale = size_px // self.size_px
        height, width = self.labels.shape
        c0, r0, c1, r1 = cell_box
        u0, v0 = max(c0 - 1, 0) * scale, max(r0 - 1, 0) * scale
        return u0, v0, min((c1 + 1) * scale, width), min((r1 + 1) * scale, height)


@kernel
def members_of(
    labels: NDArray[np.int32], label: int, box: tuple[int, int, int, int]
) -> tuple[NDArray[np.int32], tuple[int, int, int, int]]:
    """Flat indexes (N,) of a label's pixels, in the order of the image, and the box around them.

    Nothing of the label lies outside of `box` (u0, v0, u1, v1).
    """
    width = labels.shape[1]
    u0, v0, u1, v1 = box
    out, n = np.empty((u1 - u0) * (v1 - v0) + 1, np.int32), 0
    low_u, low_v, high_u, high_v = u1, v1, u0 - 1, v0 - 1
    for i in range(v0, v1):
        before, start = n, i * width
        for j in range(u0, u1):
            out[n] = start + j
            n += labels[i, j] == label
        if n > before:
            low_v, high_v = min(low_v, i), i
            low_u, high_u = min(low_u, out[before] - start), max(high_u, out[n - 1] - start)
    return out[:n].copy(), (low_u, low_v, high_u + 1, high_v + 1)


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
