"""Contain-ability as an opening: what is seen through a rim lies lower than the rim.

A sight line that comes down through the plane of the rim, inside the rim, is inside whatever is
convex by the time it is as low as the lowest point taken for rim. So a point seen lower than
that shows a hollow (paper §II.D.i: contain-ability is grounded in concavity).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from afkb_containers.clusters import Cluster

SECTORS = 16
RIM_BAND_M = 0.006
BELOW_BAND_M = 0.003
MIN_PENETRATION_M = 0.02


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
    cluster: Cluster, camera_xyz: NDArray[np.float64], min_inside: int = 12
) -> Opening | None:
    """The opening of a thing, or None where none can be made out above the noise."""
    heights = cluster.points[:, 2]
    rim = rim_height(heights)
    drop_of = camera_xyz[2] - rim
    if drop_of < 0.04:
        return None
    ray = cluster.points - camera_xyz
    slope = -ray[:, 2] / cluster.depth_m
    sigma_height = np.sqrt((cluster.sigma_m * np.abs(slope)) ** 2 + 0.001**2)
    band = np.maximum(RIM_BAND_M, 2.5 * sigma_height)
    on_rim = heights > rim - band
    if on_rim.sum() < 8:
        return None
    falling = ray[:, 2] < -0.02
    t = np.where(falling, drop_of / np.where(falling, -ray[:, 2], 1.0), 2.0)
    crossing = camera_xyz[:2] + ray[:, :2] * t[:, None]
    hull = cv2.convexHull(cluster.points[on_rim, :2].astype(np.float32))
    penetration = np.linalg.norm(ray, axis=1) * (1 - t)
    deep = (
        falling
        & (rim - heights > band + BELOW_BAND_M)
        & (penetration > max(MIN_PENETRATION_M, 4 * cluster.sigma_m))
    )
    index = np.flatnonzero(deep)
    inside = index[
        _inside(hull, crossing[index], 0.002) & _inside(hull, cluster.points[index], -0.01)
    ]
    if len(inside) < min_inside:
        return None
    through = _inside(hull, crossing, 0.0)
    depth = float(np.percentile(rim - heights[inside], 90))
    share = _share_around(cluster.points[on_rim, :2], crossing[inside])
    along = ray[inside[0], :2] / np.linalg.norm(ray[inside[0], :2])
    across = hull.reshape(-1, 2) @ along
    sight = float((across.max() - across.min()) * np.median(_steepness(ray[inside])))
    shown = len(inside) / max(int(through.sum()), 1)
    width = float(np.sqrt(max(cv2.contourArea(hull), 1e-6)))
    return Opening(rim, depth, width, share, shown, depth / max(sight, 1e-3), len(inside))


def _steepness(ray: NDArray[np.float64]) -> NDArray[np.float64]:
    """Fall of sight lines (N, 3) per metre of ground covered."""
    fall: NDArray[np.float64] = -ray[:, 2] / np.hypot(ray[:, 0], ray[:, 1])
    return fall


def rim_height(heights_m: NDArray[np.float64]) -> float:
    """Height of the upper edge of a thing: the top of its highest well-filled millimetres, m."""
    return float(np.percentile(heights_m, 98))


def _inside(
    hull: NDArray[np.float32], xy: NDArray[np.float64], margin_m: float
) -> NDArray[np.bool_]:
    """Which points (N, 2+) lie inside a convex polygon, at least margin_m from its border."""
    corners = hull.reshape(-1, 2).astype(np.float64)
    if len(corners) < 3:
        return np.zeros(len(xy), bool)
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.maximum(np.hypot(edges[:, 0], edges[:, 1]), 1e-9)
    after = np.roll(corners, -1, axis=0)
    area = np.sum(corners[:, 0] * after[:, 1] - after[:, 0] * corners[:, 1])
    inward = np.column_stack([-edges[:, 1], edges[:, 0]]) / length[:, None] * np.sign(area)
    return _beyond_all(inward, np.sum(corners * inward, axis=1) + margin_m, xy)


@njit(cache=True)
def _beyond_all(
    normals: NDArray[np.float64], offsets: NDArray[np.float64], xy: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Which points lie on the inner side of every line normal . point = offset."""
    out = np.ones(len(xy), np.bool_)
    for n in range(len(xy)):
        for k in range(len(offsets)):
            if xy[n, 0] * normals[k, 0] + xy[n, 1] * normals[k, 1] < offsets[k]:
                out[n] = False
                break
    return out


def _share_around(rim_xy: NDArray[np.float64], inside_xy: NDArray[np.float64]) -> float:
    """Share of directions, from the middle of what is seen inside, in which there is rim."""
    offset = rim_xy - inside_xy.mean(axis=0)
    sector = ((np.arctan2(offset[:, 1], offset[:, 0]) / (2 * np.pi) + 0.5) * SECTORS).astype(int)
    return len(np.unique(sector % SECTORS)) / SECTORS
