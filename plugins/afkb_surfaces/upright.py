"""Upright planes: what blocks the way (block-ability) and bounds a room."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentiles
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership
from afkb_surfaces.cells import CELL, DEPTH, X, Z
from afkb_surfaces.settings import SurfaceSettings


@kernel
def _span_of(
    u: NDArray[np.int32], v: NDArray[np.int32], cells: NDArray[np.float64], focal_px: float
) -> tuple[float, float, float, float, float, NDArray[np.float64]]:
    """Lowest and highest height, size of a cell, nearest and median depth, and places (N, 2), m."""
    n = len(u)
    heights, depths, xy = np.empty(n), np.empty(n), np.empty((n, 2))
    for k in range(n):
        cell = cells[v[k], u[k]]
        heights[k], depths[k] = cell[Z], cell[DEPTH]
        xy[k, 0], xy[k, 1] = cell[X], cell[X + 1]
    low, high = percentiles(heights, 1.0, 99.0)
    nearest, depth = percentiles(depths, 1.0, 50.0)
    size = CELL * depth / focal_px
    return low - 0.5 * size, high + 0.5 * size, size, nearest, depth, xy


def upright_detection(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    cells: NDArray[np.float64],
    focal_px: float,
    settings: SurfaceSettings,
    detector: str,
) -> Detection | None:
    """The bound that a connected set of upright cells, columns u and rows v, shows, or None.

    Its height is what is seen of it; where the image cuts it, that is a lower bound.
    """
    low, high, size, nearest, depth, xy = _span_of(u, v, cells, focal_px)
    p = membership(high - low, settings.bound_height_m)
    if p <= 0:
        return None
    segment, rms = fitted_segment(xy, size)
    along = segment[1] - segment[0]
    length = math.hypot(along[0], along[1])
    if length * (high - low) < settings.bound_area_m2:
        return None
    centre = segment.mean(axis=0)
    sigma = depth_sigma(depth)
    c0, r0, c1, r1 = extent(u, v)
    rows, cols = cells.shape[:2]
    low = max(low, 0.0)
    middle = (float(centre[0]), float(centre[1]), (low + high) / 2)
    steps = max(2, int(length / settings.footprint_step_m))
    t = np.linspace(0, 1, steps)[:, None]
    return Detection(
        detector=detector,
        affordances={"BlockAbility": 0.97 * p},
        box=OrientedBox(middle, (length, 0.02 + 2 * rms, high - low), math.atan2(*along[::-1])),
        position_xyz=np.array(middle),
        covariance_xyz=np.diag([sigma**2 + 1e-4, sigma**2 + 1e-4, 0.01]),
        footprint_xy=segment[0] * (1 - t) + segment[1] * t,
        n_pixels=len(u) * CELL * CELL,
        range_m=nearest,
        image_box=(c0 * CELL, r0 * CELL, c1 * CELL, r1 * CELL),
        segment_xy=segment,
        cut_by_image=r0 == 0 or c0 == 0 or r1 == rows or c1 == cols,
        measures={"height": high - low, "length": length, "rms": rms},
    )


def fitted_segment(xy: NDArray[np.float64], margin_m: float) -> tuple[NDArray[np.float64], float]:
    """End points (2, 2) of the line through points seen from above, and their rms about it, m."""
    centre, moments = _moments(xy)
    _, axes = np.linalg.eigh(moments)
    start, end, rms = _along(xy, centre, axes)
    ends = np.array([[start - 0.5 * margin_m], [end + 0.5 * margin_m]])
    return centre + ends * axes[:, 1], rms


@kernel
def _moments(xy: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean (2,) and covariance (2, 2) of points (N, 2); of fewer than three, a round one."""
    n = len(xy)
    centre, moments = np.zeros(2), np.zeros((2, 2))
    for k in range(n):
        centre += xy[k]
    centre /= n
    for k in range(n):
        dx, dy = xy[k, 0] - centre[0], xy[k, 1] - centre[1]
        moments[0, 0] += dx * dx
        moments[0, 1] += dx * dy
        moments[1, 1] += dy * dy
    moments[1, 0] = moments[0, 1]
    return centre, (moments / (n - 1) if n > 2 else np.eye(2))


@kernel
def _along(
    xy: NDArray[np.float64], centre: NDArray[np.float64], axes: NDArray[np.float64]
) -> tuple[float, float, float]:
    """Where points begin and end along axes[:, 1], strays left out, and rms along axes[:, 0]."""
    t, total = np.empty(len(xy)), 0.0
    for k in range(len(xy)):
        dx, dy = xy[k, 0] - centre[0], xy[k, 1] - centre[1]
        t[k] = dx * axes[0, 1] + dy * axes[1, 1]
        off = dx * axes[0, 0] + dy * axes[1, 0]
        total += off * off
    start, end = percentiles(t, 0.5, 99.5)
    return start, end, math.sqrt(total / len(xy))
