"""How much of the way around a hole in a surface there is rim, as far as a view can tell."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

RIM_CELLS = 4
"""How many cells away from a hole its rim may begin: its edge is rounded, or falls slowly."""
IMAGE_EDGE = 1 / 60
"""Share of the image's width at its edges where sensors return nothing, or nothing right."""
NEARER_M = 0.03


def ring_around(
    hole: NDArray[np.bool_],
    top: NDArray[np.uint8],
    cell_m: float,
    origin_xy: NDArray[np.float64],
    rim_m: float,
    view: View,
) -> tuple[float, float]:
    """Share of a hole's outline with rim beside it; and the share of it that the view shows.

    `hole` and `top` (X, Y): squares of the hole, and those where its surface is seen. What lies
    beyond the image, behind something nearer, or where nothing returns counts in neither.
    """
    outline = cv2.dilate(hole.astype(np.uint8), np.ones((3, 3), np.uint8)) - hole
    near = cv2.dilate(top, np.ones((2 * RIM_CELLS + 1,) * 2, np.uint8))
    ij = np.argwhere(outline > 0)
    xyz = np.column_stack([(ij + 0.5) * cell_m + origin_xy, np.full(len(ij), rim_m)])
    shown = _shown(xyz, view)
    rim = near[ij[:, 0], ij[:, 1]] > 0
    count = max(int((shown | rim).sum()), 1)
    return float(rim.sum()) / count, count / max(len(ij), 1)


def _shown(xyz: NDArray[np.float64], view: View) -> NDArray[np.bool_]:
    """Which points (N, 3), map frame, a view would show if something were there."""
    assert view.depth_m is not None and view.camera is not None
    c, T = view.camera, np.linalg.inv(view.T_map_camera)
    x, y, z = T[:3, :3] @ xyz.T + T[:3, 3:]
    edge = round(IMAGE_EDGE * c.width)
    return _uncovered(view.depth_m, c.fx * x / z + c.cx, c.fy * y / z + c.cy, z, edge)


@kernel
def _uncovered(
    depth_m: NDArray[np.float32],
    u: NDArray[np.float64],
    v: NDArray[np.float64],
    z_m: NDArray[np.float64],
    edge_px: int,
) -> NDArray[np.bool_]:
    """Which pixels lie in the image, and show something that is not nearer than z_m (N,)."""
    rows, cols = depth_m.shape
    out = np.zeros(len(u), np.bool_)
    for k in range(len(u)):
        if z_m[k] <= 0:
            continue
        if edge_px <= u[k] < cols - edge_px and edge_px <= v[k] < rows - edge_px:
            seen = depth_m[int(v[k]), int(u[k])]
            out[k] = seen > z_m[k] - NEARER_M - 3.0 * depth_sigma(z_m[k])
    return out
