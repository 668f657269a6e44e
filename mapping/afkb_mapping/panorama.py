"""What one depth image shows all around the camera, by bearing: obstacles, walls, free floor.

A virtual laser scan, as wide as the image and made of heights instead of one height, so that what
a laser at shin height looks under or through (tables, shelves) is in the way, and what is low is
told from walls.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import PinholeCamera, View
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.kernels import kernel
from afkb_mapping.per_view import once_per_view
from afkb_mapping.sensor_noise import depth_sigma

Array = NDArray[np.float64]

BEARINGS = 720
"""Directions all around: half a degree each, as a common laser's beams."""
STEP_PX = 130.0
"""Focal length (px) over this: every so many pixels are read, 0.44 degrees apart."""
STEP_OVER_M = 0.10
"""What is lower than this a robot drives over: thresholds, carpets, the floor's own noise."""
WAIST_M = 0.6
"""Seats, beds and low tables end below: they stand before no wall's end, as cabinets do."""
TALL_M = 1.1
"""What is higher than this is a wall or as tall as a person: counters, beds, chair backs end below.
"""
HEAD_M = 1.7
"""What begins above this hangs over one's head: lintels, lamps, ceilings."""
FARTHEST_M = 8.0
NOISE_SIGMAS = 3.0


@dataclass(frozen=True, slots=True, eq=False)
class Panorama:
    """Ranges by bearing about `center_xy` (2,), m, map frame; NaN where nothing was seen.

    - `bearings` (N,) rad, map frame, ascending: middle of each direction.
    - `low_m`, `tall_m`: (N,) to the nearest thing between `STEP_OVER_M` and `TALL_M`, and between
      that and `HEAD_M`; `waist_m`: of the low ones, to what reaches over `WAIST_M`.
    - `floor_m`: (N,) to the farthest floor that was seen.
    - `obstacle_m`: (N,) to the nearest thing in the way, of any height.
    - `free_m`: (N,) how far the way is seen to be free; 0 where nothing was seen.
    """

    center_xy: Array
    bearings: Array
    low_m: Array
    waist_m: Array
    tall_m: Array
    floor_m: Array
    obstacle_m: Array
    free_m: Array

    def ends_xy(self, ranges_m: Array) -> Array:
        """(N, 2) m: where distances in each direction end."""
        along = np.column_stack([np.cos(self.bearings), np.sin(self.bearings)])
        ends: Array = self.center_xy + ranges_m[:, None] * along
        return ends

    def at(self, points_xy: Array) -> tuple[NDArray[np.intp], Array]:
        """Index of the direction of points (M, 2), map frame, and their distances, m."""
        off = points_xy - self.center_xy
        turn = (np.arctan2(off[:, 1], off[:, 0]) + math.pi) / (2 * math.pi)
        index = (turn * len(self.bearings)).astype(np.intp) % len(self.bearings)
        return index, np.hypot(off[:, 0], off[:, 1])


@once_per_view
def panorama_of(view: View) -> Panorama | None:
    """The panorama of a placed view; None where it has no depth. Detectors and mapper share it."""
    if view.depth_m is None or view.camera is None:
        return None
    T = view.T_map_camera
    ranges = _ranges(view.depth_m, intrinsics_of(view), T, pixel_step(view.camera))
    ranges[~np.isfinite(ranges)] = np.nan
    turns: Array = (np.arange(BEARINGS, dtype=np.float64) + 0.5) / BEARINGS
    bearings = turns * (2 * math.pi) - math.pi
    waist, tall, floor = ranges[3], ranges[5], ranges[6]
    low = np.fmin(ranges[1], waist)
    obstacle = np.fmin(low, tall)
    free = np.nan_to_num(np.where(np.isnan(obstacle), floor, obstacle))
    return Panorama(T[:2, 3].copy(), bearings, low, waist, tall, floor, obstacle, free)


def pixel_step(camera: PinholeCamera) -> int:
    """Every so many pixels of a row, and of a column, say what stands where."""
    return max(1, round(camera.fx / STEP_PX))


@kernel
def _ranges(depth_m: NDArray[np.float32], intrinsics: Array, T: Array, step: int) -> Array:
    """(7, BEARINGS) m: nearest and second nearest thing of each height, then the farthest floor.

    The second nearest is what counts: single pixels at edges float in the air.
    """
    fx, fy, cx, cy = intrinsics
    found = np.full((7, BEARINGS), np.inf)
    found[6] = -np.inf
    per_rad = BEARINGS / (2 * math.pi)
    ax, ay, az = T[0, 0], T[1, 0], T[2, 0]
    for v in range(0, depth_m.shape[0], step):
        yc = (v - cy) / fy
        # Of a ray of this row: its way along each axis of the map, but for its column's part.
        bx, by, bz = T[0, 1] * yc + T[0, 2], T[1, 1] * yc + T[1, 2], T[2, 1] * yc + T[2, 2]
        for u in range(0, depth_m.shape[1], step):
            d = float(depth_m[v, u])
            if not 0.0 < d < FARTHEST_M:
                continue
            xc = (u - cx) / fx
            height = d * (az * xc + bz) + T[2, 3]
            if height >= HEAD_M:
                continue
            x, y = ax * xc + bx, ay * xc + by
            r = d * math.sqrt(x * x + y * y)
            k = min(int((bearing(y, x) + math.pi) * per_rad), BEARINGS - 1)
            slack = max(STEP_OVER_M, NOISE_SIGMAS * depth_sigma(d))
            if height < slack:
                if height > -slack:
                    found[6, k] = max(found[6, k], r)
                continue
            row = 0 if height < WAIST_M else 2 if height < TALL_M else 4
            if r < found[row, k]:
                found[row + 1, k] = found[row, k]
                found[row, k] = r
            elif r < found[row + 1, k]:
                found[row + 1, k] = r
    return found


@kernel
def bearing(y: float, x: float) -> float:
    """`atan2`, rad, in a third of its time (Hastings 1955, sheet 11): off by 0.00002 at most."""
    far, near = max(abs(x), abs(y)), min(abs(x), abs(y))
    t = near / max(far, 1e-12)
    s = t * t
    a = t * (0.999866 + s * (-0.3302995 + s * (0.180141 + s * (-0.085133 + s * 0.0208351))))
    if abs(y) > abs(x):
        a = math.pi / 2 - a
    if x < 0:
        a = math.pi - a
    return -a if y < 0 else a
