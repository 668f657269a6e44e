"""What depth adds to a gap: whether its jambs are tall, whether it is open, what hangs over it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_doorways.gaps import BEYOND_M, Gap
from afkb_mapping.kernels import kernel
from afkb_mapping.panorama import HEAD_M, STEP_PX, Panorama

Array = NDArray[np.float64]

SAME_M = 0.2
"""A tall thing this near to where the jamb stands is the jamb: sensors' errors at a few metres."""
OVER_M = 0.4
"""Where the nearest tall thing is this much further, one looks over what was taken for a jamb."""
LEAST_DIRECTIONS = 2
"""In fewer directions nothing is said."""
LINTEL_REACH_M = 0.25
"""A lintel lies no further from the line between the jambs: half a thick wall, and noise."""
LINTEL_SHARE = 0.5
"""It spans at least this part of the gap, else it is a lamp or a sign."""
SLICES = 16
STEEPEST_RAD = math.radians(85.0)


@dataclass(frozen=True, slots=True)
class GapEvidence:
    """What was seen of a gap besides the gap; NaN where nothing was.

    - `tall`: share of each jamb's directions in which it is tall.
    - `open`: share of the gap's directions that are free at every height.
    - `lintel_m`: height of its lintel's lower edge.
    """

    tall: tuple[float, float]
    open: float
    lintel_m: float


NOTHING_SEEN = GapEvidence((math.nan, math.nan), math.nan, math.nan)


def evidence_of(gap: Gap, view: View, panorama: Panorama) -> GapEvidence:
    """What a view's depth says of a gap that it, or the laser beside it, shows."""
    about = panorama.center_xy
    obstacle, free = panorama.obstacle_m, panorama.free_m
    return GapEvidence(
        (
            _tall(gap.sides[0], about, panorama.tall_m),
            _tall(gap.sides[1], about, panorama.tall_m),
        ),
        _open(gap.jambs_xy, about, obstacle, free),
        lintel_height(gap.jambs_xy, view),
    )


@kernel
def _direction(x: float, y: float, n: int) -> int:
    """Index of the direction of a point as seen from a panorama's centre."""
    return int((math.atan2(y, x) + math.pi) / (2 * math.pi) * n) % n


@kernel
def _tall(side_xy: Array, about_xy: Array, tall_m: Array) -> float:
    """Share of the points of a jamb at which it reaches over `TALL_M`; NaN where unknown."""
    tall, low = 0, 0
    for k in range(len(side_xy)):
        x, y = side_xy[k, 0] - about_xy[0], side_xy[k, 1] - about_xy[1]
        off = math.hypot(x, y)
        beyond = tall_m[_direction(x, y, len(tall_m))] - off
        tall += abs(beyond) < SAME_M
        low += beyond > OVER_M
    return tall / (tall + low) if tall + low >= LEAST_DIRECTIONS else math.nan


@kernel
def _open(jambs_xy: Array, about_xy: Array, obstacle_m: Array, free_m: Array) -> float:
    """Share of the directions through a gap in which the way is free at every height."""
    is_open, shut = 0, 0
    for k in range(SLICES):
        t = (k + 1) / (SLICES + 1)
        x = jambs_xy[0, 0] * (1 - t) + jambs_xy[1, 0] * t - about_xy[0]
        y = jambs_xy[0, 1] * (1 - t) + jambs_xy[1, 1] * t - about_xy[1]
        off, at = math.hypot(x, y), _direction(x, y, len(free_m))
        if obstacle_m[at] < off + BEYOND_M:
            shut += 1
        elif free_m[at] > off:
            is_open += 1
    return is_open / (is_open + shut) if is_open + shut >= LEAST_DIRECTIONS else math.nan


def lintel_height(jambs_xy: Array, view: View) -> float:
    """Height of the lower edge of what spans a gap above head height, m; NaN where none is seen."""
    if view.depth_m is None or view.camera is None:
        return math.nan
    camera, T = view.camera, view.T_map_camera
    if _top_of_view(T, camera.fy, camera.cy, jambs_xy) < HEAD_M:
        return math.nan
    intrinsics = np.array([camera.fx, camera.fy, camera.cx, camera.cy])
    step = max(1, round(camera.fx / STEP_PX))
    heights = _overhead(view.depth_m, intrinsics, T, jambs_xy, step)
    lowest = heights[np.isfinite(heights)]
    return float(np.median(lowest)) if len(lowest) >= LINTEL_SHARE * SLICES else math.nan


def _top_of_view(T: Array, fy: float, cy: float, jambs_xy: Array) -> float:
    """Height that the image's upper edge shows above a gap, m; an upper bound for a rolled one."""
    middle = jambs_xy[0] + jambs_xy[1]
    off = math.hypot(middle[0] / 2 - T[0, 3], middle[1] / 2 - T[1, 3])
    pitch, roll_slack = math.asin(_unit(T[2, 2])), abs(math.asin(_unit(T[2, 0])))
    angle = min(pitch + math.atan2(cy, fy) + roll_slack, STEEPEST_RAD)
    return float(T[2, 3]) + off * math.tan(angle)


def _unit(value: float) -> float:
    return min(1.0, max(-1.0, float(value)))


@kernel
def _overhead(
    depth_m: NDArray[np.float32], intrinsics: Array, T: Array, jambs_xy: Array, step: int
) -> Array:
    """(SLICES,) lowest point above head height in each slice of the gap, m; inf where none is."""
    fx, fy, cx, cy = intrinsics
    lowest = np.full((2, SLICES), np.inf)
    x0, y0 = jambs_xy[0]
    ux, uy = jambs_xy[1, 0] - x0, jambs_xy[1, 1] - y0
    width = math.sqrt(ux * ux + uy * uy)
    ux, uy = ux / width, uy / width
    for v in range(0, depth_m.shape[0], step):
        yc = (v - cy) / fy
        for u in range(0, depth_m.shape[1], step):
            d = float(depth_m[v, u])
            if d <= 0.0:
                continue
            xc = (u - cx) / fx
            height = d * (T[2, 0] * xc + T[2, 1] * yc + T[2, 2]) + T[2, 3]
            if height < HEAD_M:
                continue
            x = d * (T[0, 0] * xc + T[0, 1] * yc + T[0, 2]) + T[0, 3] - x0
            y = d * (T[1, 0] * xc + T[1, 1] * yc + T[1, 2]) + T[1, 3] - y0
            along, across = x * ux + y * uy, x * uy - y * ux
            if abs(across) > LINTEL_REACH_M or along <= 0.0 or along >= width:
                continue
            k = int(along / width * SLICES)
            if height < lowest[0, k]:
                lowest[1, k] = lowest[0, k]
                lowest[0, k] = height
            elif height < lowest[1, k]:
                lowest[1, k] = height
    second: Array = lowest[1]
    return second
