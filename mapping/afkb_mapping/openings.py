"""Contain-ability as an opening: what is seen through a rim lies lower than the rim.

A sight line that comes down through the plane of the rim, inside the rim, is inside whatever is
convex by the time it is as low as the lowest point taken for rim. So a point seen lower than
that shows a hollow (paper §II.D.i: contain-ability is grounded in concavity).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.from_above import hull_candidates
from afkb_mapping.opening_kernels import (
    border_lines,
    depth_and_steepness,
    ends_on_top,
    rim_of,
    seen_inside,
    share_around,
)
from afkb_mapping.order_statistics import percentile

LEAST_DROP_M = 0.04
"""The camera must be this much higher than a rim to look into it."""
MIN_RIM = 8
LEAST_THROUGH, LEAST_BANDS = 12, 2.0


@dataclass(frozen=True, slots=True)
class Opening:
    """An opening upwards: rim height above the floor, depth seen below it, width across (m).

    `sight_share`: depth seen, as a share of what sight lines through that rim could show.
    `rim_share`: how much of the way around the rim is seen; `n_inside`: pixels seen inside.
    """

    rim_height_m: float
    depth_m: float
    width_m: float
    rim_share: float
    inside_share: float
    sight_share: float
    n_inside: int


@dataclass(frozen=True, slots=True)
class Top:
    """What is seen where sight lines come down through the plane of a thing's rim or top.

    - `n_through`: sight lines that cross it well inside its border, and `lid_share`: how many of
      them end on it. A lid ends them all; of a hollow, it is what noise lifts to the rim.
    - `sight_m`: how far below the rim a sight line that comes in over the near side of a hollow
      would end, and `band_m`: how far noise may put a point of the rim below it.
    - `area_m2`: of the hull of what lies at its height.
    - `opening`: None where nothing lower can be made out above the noise.
    """

    height_m: float
    area_m2: float
    n_through: int
    lid_share: float
    sight_m: float
    band_m: float
    opening: Opening | None

    @property
    def tells(self) -> bool:
        """Whether a hollow would show from here: enough sight lines, steep enough for the noise."""
        return self.n_through >= LEAST_THROUGH and self.sight_m >= LEAST_BANDS * self.band_m


def find_opening(
    body: Body, camera_xyz: NDArray[np.float64], min_inside: int = 12, sigma_m: float | None = None
) -> Opening | None:
    """The opening of a thing, or None where none can be made out above the noise."""
    top = look_at_top(body, camera_xyz, min_inside, sigma_m)
    return top.opening if top else None


def look_at_top(
    body: Body, camera_xyz: NDArray[np.float64], min_inside: int = 12, sigma_m: float | None = None
) -> Top | None:
    """What is seen of the upper end of a thing; None where the camera does not look down on it.

    `sigma_m`: standard deviation of its depth, by the sensor's model unless told.
    """
    points, sigma = body.points, body.sigma_m if sigma_m is None else sigma_m
    rim = percentile(points[:, 2], 98.0)
    if camera_xyz[2] - rim < LEAST_DROP_M:
        return None
    bands, rim_xy = rim_of(points, body.depth_m, camera_xyz, rim, sigma)
    if len(rim_xy) < MIN_RIM:
        return None
    hull = cv2.convexHull(hull_candidates(rim_xy)).reshape(-1, 2)
    if len(hull) < 3:
        return None
    lines = border_lines(hull.astype(np.float64))
    seen = seen_inside(points, bands, camera_xyz, rim, sigma, *lines)
    n_through, lid_share = ends_on_top(points, bands, camera_xyz, rim, *lines)
    sight = _sight(hull, rim, points, camera_xyz)
    opening = None
    if len(seen[0]) >= min_inside:
        opening = _opening(points, hull, rim_xy, camera_xyz, rim, *seen)
    return Top(
        rim, cv2.contourArea(hull), n_through, lid_share, sight, percentile(bands, 50.0), opening
    )


def _sight(
    hull: NDArray[np.float32],
    rim_m: float,
    points: NDArray[np.float64],
    camera_xyz: NDArray[np.float64],
) -> float:
    """How far sight lines fall on their way across the hull of a rim, m."""
    ray = points[0, :2] - camera_xyz[:2]
    far = math.hypot(*ray)
    across = hull @ (ray / far)
    return float(across.max() - across.min()) * float(camera_xyz[2] - rim_m) / far


def _opening(
    points: NDArray[np.float64],
    hull: NDArray[np.float32],
    rim_xy: NDArray[np.float64],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
    inside: NDArray[np.int64],
    crossing: NDArray[np.float64],
    through: int,
) -> Opening:
    """The opening that points `inside` show, which sight lines to them enter at `crossing`."""
    depth, steepness = depth_and_steepness(points, inside, camera_xyz, rim_m)
    ray = points[inside[0], :2] - camera_xyz[:2]
    across = hull @ (ray / math.hypot(*ray))
    sight = float(across.max() - across.min()) * steepness
    return Opening(
        rim_height_m=rim_m,
        depth_m=depth,
        width_m=math.sqrt(max(cv2.contourArea(hull), 1e-6)),
        rim_share=share_around(rim_xy, crossing),
        inside_share=len(inside) / max(through, 1),
        sight_share=depth / max(sight, 1e-3),
        n_inside=len(inside),
    )
