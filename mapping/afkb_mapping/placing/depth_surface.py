"""Upright surface of a depth image, as a laser at each of several heights would have met it.

Walls, fronts of furniture and jambs stand upright: seen from above, all of their points between
two heights lie on one line. Table tops and floors don't, and a laser would not meet them either.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.kernels import kernel
from afkb_mapping.panorama import BEARINGS, STEP_PX, bearing
from afkb_mapping.placing.scan_surface import (
    RANGE_SIGMA_M,
    SurfacePoints,
    no_surface,
    surface_of_rows,
)
from afkb_mapping.placing.surface_map import thinned
from afkb_mapping.sensor_noise import depth_sigma

Array = NDArray[np.float64]

LOWEST_M, LAYER_M, LAYERS = 0.10, 0.20, 10
"""Layers of height, from above what is the floor's noise to above a person's head: in each, what
stands upright is told from what lies or hangs."""
FARTHEST_M = 5.0
"""Further away depth is wrong by more than walls are thick."""
LEAST_PIXELS = 4
"""Fewer pixels of one bearing and layer may be a thing's edge."""
UPRIGHT_M = 0.02
"""Greatest spread of the distances of one bearing and layer, beside the sensor's noise: what leans
by this much over a layer still stands."""
NOISE_SIGMAS = 2.0


def depth_surface_of(view: View, T_map_base: Array) -> SurfacePoints:
    """What stands upright, in the map frame, were the level base there; none without depth.

    `level` of each point is the number of its layer; at most one point a cell of the map.
    """
    if view.depth_m is None or view.camera is None or view.T_base_camera is None:
        return no_surface()
    T = T_map_base @ view.T_base_camera
    step = max(1, round(view.camera.fx / STEP_PX))
    sums = _sums(view.depth_m, intrinsics_of(view), T, step)
    level, direction = np.nonzero(sums[..., 0] >= LEAST_PIXELS)
    x, y, r, rr, sigma = sums[level, direction, 1:].T / sums[level, direction, 0]
    upright = np.sqrt(np.maximum(rr - r * r, 0)) < UPRIGHT_M + NOISE_SIGMAS * sigma
    points = np.column_stack([x, y])[upright]
    noise = np.hypot(RANGE_SIGMA_M, sigma[upright])
    found = surface_of_rows(points, level[upright], noise)
    return thinned(found.moved(np.eye(2), T[:2, 3]))


@kernel
def _sums(depth_m: NDArray[np.float32], intrinsics: Array, T: Array, step: int) -> Array:
    """(LAYERS, BEARINGS, 6) sums by layer and bearing from the camera.

    Of each: count, x, y (from the camera, map axes), horizontal range, its square, depth's sigma.
    """
    fx, fy, cx, cy = intrinsics
    found = np.zeros((LAYERS, BEARINGS, 6))
    per_rad = BEARINGS / (2 * math.pi)
    for v in range(0, depth_m.shape[0], step):
        yc = (v - cy) / fy
        bx, by, bz = T[0, 1] * yc + T[0, 2], T[1, 1] * yc + T[1, 2], T[2, 1] * yc + T[2, 2]
        for u in range(0, depth_m.shape[1], step):
            d = float(depth_m[v, u])
            if not 0.0 < d < FARTHEST_M:
                continue
            xc = (u - cx) / fx
            layer = math.floor((d * (T[2, 0] * xc + bz) + T[2, 3] - LOWEST_M) / LAYER_M)
            if not 0 <= layer < LAYERS:
                continue
            x, y = d * (T[0, 0] * xc + bx), d * (T[1, 0] * xc + by)
            r = math.sqrt(x * x + y * y)
            k = min(int((bearing(y, x) + math.pi) * per_rad), BEARINGS - 1)
            cell = found[layer, k]
            cell[0] += 1
            cell[1] += x
            cell[2] += y
            cell[3] += r
            cell[4] += r * r
            cell[5] += depth_sigma(d)
    return found
