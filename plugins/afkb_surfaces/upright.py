"""Upright planes: what blocks the way (block-ability) and bounds a room."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox
from afkb_surfaces.cells import CELL, DEPTH, X, Z
from afkb_surfaces.noise import depth_sigma
from afkb_surfaces.settings import SurfaceSettings, membership


def upright_detection(
    rc: NDArray[np.intp],
    cells: NDArray[np.float64],
    focal_px: float,
    settings: SurfaceSettings,
    detector: str,
) -> Detection | None:
    """The bound that a connected set of upright cells (N, 2 of row, column) shows, or None.

    Its height is what is seen of it; where the image cuts it, that is a lower bound.
    """
    values = cells[rc[:, 0], rc[:, 1]]
    size = CELL * values[:, DEPTH] / focal_px
    low, high = np.percentile(values[:, Z], [1, 99]) + np.array([-0.5, 0.5]) * np.median(size)
    p = membership(float(high - low), settings.bound_height_m)
    if p <= 0:
        return None
    segment, rms = fitted_segment(values[:, X : X + 2], float(np.median(size)))
    length = float(np.hypot(*(segment[1] - segment[0])))
    if length * (high - low) < settings.bound_area_m2:
        return None
    centre = segment.mean(axis=0)
    along = segment[1] - segment[0]
    yaw = math.atan2(along[1], along[0])
    sigma = float(depth_sigma(float(np.median(values[:, DEPTH]))))
    (r0, c0), (r1, c1) = rc.min(axis=0), rc.max(axis=0) + 1
    rows, cols = cells.shape[:2]
    low = max(float(low), 0.0)
    middle = (float(centre[0]), float(centre[1]), (low + float(high)) / 2)
    steps = max(2, int(length / settings.footprint_step_m))
    t = np.linspace(0, 1, steps)[:, None]
    return Detection(
        detector=detector,
        affordances={"BlockAbility": 0.97 * p},
        box=OrientedBox(middle, (length, 0.02 + 2 * rms, float(high) - low), yaw),
        position_xyz=np.array(middle),
        covariance_xyz=np.diag([sigma**2 + 1e-4, sigma**2 + 1e-4, 0.01]),
        footprint_xy=segment[0] * (1 - t) + segment[1] * t,
        n_pixels=len(rc) * CELL * CELL,
        range_m=float(np.percentile(values[:, DEPTH], 1)),
        image_box=(int(c0) * CELL, int(r0) * CELL, int(c1) * CELL, int(r1) * CELL),
        segment_xy=segment,
        cut_by_image=bool(r0 == 0 or c0 == 0 or r1 == rows or c1 == cols),
        measures={"height": float(high) - low, "length": length, "rms": rms},
    )


def fitted_segment(xy: NDArray[np.float64], margin_m: float) -> tuple[NDArray[np.float64], float]:
    """End points (2, 2) of the line through points seen from above, and their rms about it, m."""
    centre = xy.mean(axis=0)
    _, axes = np.linalg.eigh(np.cov((xy - centre).T) if len(xy) > 2 else np.eye(2))
    along, across = axes[:, 1], axes[:, 0]
    t = (xy - centre) @ along
    ends = np.percentile(t, [0.5, 99.5]) + np.array([-0.5, 0.5]) * margin_m
    rms = float(np.sqrt(np.mean(((xy - centre) @ across) ** 2)))
    return centre + ends[:, None] * along, rms
