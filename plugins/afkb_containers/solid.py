"""Intrinsic contain-ability: a closed, compact, convex body (paper §II.F: cans, cartons, boxes)."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from afkb_containers.clusters import Cluster
from afkb_containers.settings import ContainerSettings
from afkb_mapping.trapezoids import membership

SOLIDITY = (0.75, 0.90)
"""Share of its image's convex hull that a body must fill: not at all below, fully above."""
WHOLE = (0.50, 0.70)
"""The same for a hollow body, whose handle or spout stands off: plants and rails fall below."""
SLENDER = 8.0
UNSURE = 1.5
"""Standard deviations of depth by which a thickness must exceed what is thin."""
LEAN_DEG = (9.0, 18.0)
"""Cartons and cans stand upright; what leans further is a frame, a book or a screen."""
NORMAL_2_TO_98 = 4.1
"""Distance between the 2nd and the 98th percentile of normal noise, in standard deviations."""


@dataclass(frozen=True, slots=True)
class Solid:
    """How much a thing is a closed body (`degree`) or one body (`whole`), 0 to 1; measures in m."""

    degree: float
    height_m: float
    thickness_m: float
    length_m: float
    solidity: float
    whole: float


def solid_of(cluster: Cluster, base_m: float, settings: ContainerSettings) -> Solid:
    """Judge a thing by height, thickness and convexity; size from above is the caller's."""
    top = float(np.percentile(cluster.points[:, 2], 98))
    height = top - base_m
    length, _ = sides_from_above(cluster)
    width, lean = thickness_and_lean(cluster)
    fill = image_solidity(cluster)
    degree = (
        membership(height, settings.solid_height_m)
        * membership(max(height, length), settings.max_extent_m)
        * membership(width - UNSURE * cluster.sigma_m, settings.solid_thickness_m)
        * (1.0 - _ramp(lean, LEAN_DEG))
        * _ramp(fill, SOLIDITY)
    )
    if max(height, length) > SLENDER * max(width, 1e-3):
        degree = 0.0
    return Solid(degree, height, width, length, fill, _ramp(fill, WHOLE))


def _ramp(value: float, limits: tuple[float, float]) -> float:
    return min(max((value - limits[0]) / (limits[1] - limits[0]), 0.0), 1.0)


def sides_from_above(cluster: Cluster) -> tuple[float, float]:
    """Longer and shorter side of the smallest rectangle around a thing, strays left out, m."""
    xy = cluster.points[:: max(1, len(cluster.points) // 1500), :2]
    (cx, cy), _, degrees = cv2.minAreaRect(xy.astype(np.float32))
    turn = np.radians(degrees)
    R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    local = (xy - (cx, cy)) @ R
    sides = np.subtract(*np.percentile(local, [98, 2], axis=0))
    return float(max(sides)), float(min(sides))


def thickness_and_lean(cluster: Cluster) -> tuple[float, float]:
    """Extent across the plane that fits a thing best, less what noise adds (m), and its lean.

    A frame that leans back is deep when seen from above, and thin across its own plane; the lean
    (degrees from upright) is 0 where that plane lies rather than stands.
    """
    centred = cluster.points - cluster.points.mean(axis=0)
    _, axes = np.linalg.eigh(centred.T @ centred)
    low, high = np.percentile(centred @ axes[:, 0], [2, 98])
    noise = NORMAL_2_TO_98 * cluster.sigma_m
    lean = float(np.degrees(np.arcsin(min(abs(axes[2, 0]), 1.0))))
    return float(np.sqrt(max((high - low) ** 2 - noise**2, 0.0))), lean if lean < 40 else 0.0


def image_solidity(cluster: Cluster) -> float:
    """Share of the convex hull of its pixels that a thing fills, holes of lost pixels closed."""
    u0, v0, u1, v1 = cluster.image_box
    mask = np.zeros((v1 - v0 + 4, u1 - u0 + 4), np.uint8)
    mask[cluster.v - v0 + 2, cluster.u - u0 + 2] = 1
    mask = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    hull = cv2.convexHull(np.argwhere(mask)[:, ::-1].astype(np.int32))
    full = np.zeros_like(mask)
    cv2.fillConvexPoly(full, hull, 1)
    return float(mask.sum() / max(int(full.sum()), 1))
