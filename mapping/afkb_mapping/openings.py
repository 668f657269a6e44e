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
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile

SECTORS = 16
RIM_BAND_M = 0.006
BELOW_BAND_M = 0.003
MIN_PENETRATION_M = 0.02
LEAST_DROP_M = 0.04
"""The camera must be this much higher than a rim to look into it."""
FALLING_M = -0.02
MIN_RIM = 8
CROSSING_MARGIN_M, POINT_MARGIN_M = 0.002, -0.01
"""How far inside the rim a sight line crosses its plane, and how far what it ends at may lie."""


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


def find_opening(
    body: Body, camera_xyz: NDArray[np.float64], min_inside: int = 12
) -> Opening | None:
    """The opening of a thing, or None where none can be made out above the noise."""
    points, sigma = body.points, body.sigma_m
    rim = percentile(points[:, 2], 98.0)
    if camera_xyz[2] - rim < LEAST_DROP_M:
        return None
    bands, rim_xy = _rim_of(points, body.depth_m, camera_xyz, rim, sigma)
    if len(rim_xy) < MIN_RIM:
        return None
    hull = cv2.convexHull(hull_candidates(rim_xy)).reshape(-1, 2)
    if len(hull) < 3:
        return None
    normals, offsets = _border_lines(hull.astype(np.float64))
    inside, crossing, through = _seen_inside(
        points, bands, camera_xyz, rim, sigma, normals, offsets
    )
    if len(inside) < min_inside:
        return None
    depth, steepness = _depth_and_steepness(points, inside, camera_xyz, rim)
    ray = points[inside[0], :2] - camera_xyz[:2]
    across = hull @ (ray / math.hypot(*ray))
    sight = float(across.max() - across.min()) * steepness
    return Opening(
        rim_height_m=rim,
        depth_m=depth,
        width_m=math.sqrt(max(cv2.contourArea(hull), 1e-6)),
        rim_share=_share_around(rim_xy, crossing),
        inside_share=len(inside) / max(through, 1),
        sight_share=depth / max(sight, 1e-3),
        n_inside=len(inside),
    )


@kernel
def _rim_of(
    points: NDArray[np.float64],
    depth_m: NDArray[np.float32],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
    sigma_m: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far each point (N, 3) may lie below the rim by noise alone, m; (M, 2) of those on it."""
    n = len(points)
    bands, rim_xy, count = np.empty(n), np.empty((n, 2)), 0
    for k in range(n):
        slope = (points[k, 2] - camera_xyz[2]) / depth_m[k]
        bands[k] = max(RIM_BAND_M, 2.5 * math.sqrt((sigma_m * slope) ** 2 + 0.001**2))
        if points[k, 2] > rim_m - bands[k]:
            rim_xy[count, 0], rim_xy[count, 1] = points[k, 0], points[k, 1]
            count += 1
    return bands, rim_xy[:count]


@kernel
def _border_lines(
    corners: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Inward normals (K, 2) and offsets (K,) of a convex polygon: inside, normal . p >= offset."""
    n = len(corners)
    normals, offsets, area = np.empty((n, 2)), np.empty(n), 0.0
    for k in range(n):
        a, b = corners[k], corners[(k + 1) % n]
        area += a[0] * b[1] - b[0] * a[1]
        length = max(math.hypot(b[0] - a[0], b[1] - a[1]), 1e-9)
        normals[k, 0], normals[k, 1] = (a[1] - b[1]) / length, (b[0] - a[0]) / length
    normals *= np.sign(area)
    for k in range(n):
        offsets[k] = corners[k, 0] * normals[k, 0] + corners[k, 1] * normals[k, 1]
    return normals, offsets


@kernel
def _within(
    x: float, y: float, normals: NDArray[np.float64], offsets: NDArray[np.float64], margin: float
) -> bool:
    """Whether a point lies inside a convex polygon, at least a margin (m) from its border."""
    for k in range(len(offsets)):
        if x * normals[k, 0] + y * normals[k, 1] < offsets[k] + margin:
            return False
    return True


@kernel
def _seen_inside(
    points: NDArray[np.float64],
    bands: NDArray[np.float64],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
    sigma_m: float,
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.float64], int]:
    """Points clearly below the rim and seen through it: indexes, and where (N, 2) they cross it.

    And the number of sight lines that cross the rim's plane within the rim.
    """
    inside, crossing = np.empty(len(points), np.int64), np.empty((len(points), 2))
    count = through = 0
    drop, least = camera_xyz[2] - rim_m, max(MIN_PENETRATION_M, 4 * sigma_m)
    for k in range(len(points)):
        dx, dy = points[k, 0] - camera_xyz[0], points[k, 1] - camera_xyz[1]
        dz = points[k, 2] - camera_xyz[2]
        falling = dz < FALLING_M
        t = drop / -dz if falling else 2.0
        x, y = camera_xyz[0] + dx * t, camera_xyz[1] + dy * t
        if not _within(x, y, normals, offsets, 0.0):
            continue
        through += 1
        if not falling or rim_m - points[k, 2] <= bands[k] + BELOW_BAND_M:
            continue
        if math.sqrt(dx * dx + dy * dy + dz * dz) * (1 - t) <= least:
            continue
        if _within(x, y, normals, offsets, CROSSING_MARGIN_M) and _within(
            points[k, 0], points[k, 1], normals, offsets, POINT_MARGIN_M
        ):
            inside[count], crossing[count, 0], crossing[count, 1] = k, x, y
            count += 1
    return inside[:count], crossing[:count], through


@kernel
def _depth_and_steepness(
    points: NDArray[np.float64],
    inside: NDArray[np.int64],
    camera_xyz: NDArray[np.float64],
    rim_m: float,
) -> tuple[float, float]:
    """Depth seen below the rim, m, and the fall of its sight lines per metre of ground covered."""
    n = len(inside)
    below, fall = np.empty(n), np.empty(n)
    for k in range(n):
        p = points[inside[k]]
        below[k] = rim_m - p[2]
        fall[k] = (camera_xyz[2] - p[2]) / math.hypot(p[0] - camera_xyz[0], p[1] - camera_xyz[1])
    return percentile(below, 90.0), percentile(fall, 50.0)


@kernel
def _share_around(rim_xy: NDArray[np.float64], inside_xy: NDArray[np.float64]) -> float:
    """Share of directions, from the middle of what is seen inside, in which there is rim."""
    x = y = 0.0
    for k in range(len(inside_xy)):
        x, y = x + inside_xy[k, 0], y + inside_xy[k, 1]
    x, y = x / len(inside_xy), y / len(inside_xy)
    seen = np.zeros(SECTORS, np.bool_)
    for k in range(len(rim_xy)):
        turn = math.atan2(rim_xy[k, 1] - y, rim_xy[k, 0] - x) / (2 * math.pi) + 0.5
        seen[int(turn * SECTORS) % SECTORS] = True
    return seen.sum() / SECTORS
