"""Which pixels show something that stands on which support."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_surfaces.noise import depth_sigma

RASTER_M = 0.02
HULL_MARGIN_CELLS = 1
LARGE_SUPPORT_M2 = 0.12
MAX_SUPPORTS = 62


@njit(cache=True)
def map_points(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
) -> NDArray[np.float32]:
    """Points of a depth image in the map frame: (H, W, 3) float32; zero where nothing returned."""
    fx, fy, cx, cy = intrinsics
    T = T_map_camera
    height, width = depth_m.shape
    out = np.zeros((height, width, 3), np.float32)
    for v in range(height):
        y = (v - cy) / fy
        for u in range(width):
            z = depth_m[v, u]
            if z > 0:
                x = (u - cx) / fx
                for k in range(3):
                    out[v, u, k] = (T[k, 0] * x + T[k, 1] * y + T[k, 2]) * z + T[k, 3]
    return out


@dataclass(frozen=True, slots=True, eq=False)
class Supports:
    """Supports of a view, highest first, and a raster of which of them lie under a spot.

    `raster`: (X, Y) uint64, bit k for support k; its corner is at `origin_xy`.
    """

    detections: tuple[Detection, ...]
    heights_m: NDArray[np.float64]
    large: NDArray[np.bool_]
    raster: NDArray[np.uint64]
    origin_xy: NDArray[np.float64]

    @classmethod
    def of(cls, earlier: Sequence[Detection]) -> Supports:
        """The supports among a view's detections, the floor left out."""
        chosen = [
            d
            for d in earlier
            if d.affords("SupportAbility", 0.3)
            and not d.measures.get("is_floor")
            and len(d.footprint_xy) >= 3
        ]
        chosen.sort(key=lambda d: (-d.n_pixels, tuple(d.position_xyz)))
        chosen = sorted(chosen[:MAX_SUPPORTS], key=lambda d: -float(d.position_xyz[2]))
        heights = np.array([float(d.position_xyz[2]) for d in chosen])
        areas = np.array([d.measures.get("area", 0.0) for d in chosen])
        raster, origin = _raster(chosen)
        return cls(tuple(chosen), heights, areas >= LARGE_SUPPORT_M2, raster, origin)


def _raster(chosen: Sequence[Detection]) -> tuple[NDArray[np.uint64], NDArray[np.float64]]:
    if not chosen:
        return np.zeros((1, 1), np.uint64), np.zeros(2)
    pad = (HULL_MARGIN_CELLS + 2) * RASTER_M
    origin = np.min([d.footprint_xy.min(axis=0) for d in chosen], axis=0) - pad
    far = np.max([d.footprint_xy.max(axis=0) for d in chosen], axis=0) + pad
    shape = np.ceil((far - origin) / RASTER_M).astype(int) + 1
    raster = np.zeros((int(shape[0]), int(shape[1])), np.uint64)
    kernel = np.ones((2 * HULL_MARGIN_CELLS + 1,) * 2, np.uint8)
    for k, d in enumerate(chosen):
        ij = np.floor((d.footprint_xy - origin) / RASTER_M).astype(np.int32)
        low = ij.min(axis=0) - HULL_MARGIN_CELLS
        size = ij.max(axis=0) - low + 1 + HULL_MARGIN_CELLS
        mask = np.zeros((int(size[0]), int(size[1])), np.uint8)
        hull = cv2.convexHull((ij - low)[:, ::-1].astype(np.int32))
        cv2.fillConvexPoly(mask, hull, 1)
        mask = cv2.dilate(mask, kernel)
        raster[low[0] : low[0] + size[0], low[1] : low[1] + size[1]] |= mask.astype(
            np.uint64
        ) << np.uint64(k)
    return raster, origin


@njit(cache=True)
def label_things(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    heights_m: NDArray[np.float64],
    large: NDArray[np.bool_],
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
    slope: NDArray[np.float64],
    low_m: float,
    high_m: float,
) -> NDArray[np.int16]:
    """Support, from 1, that each pixel's point stands on: (H, W); 0 none, -1 on a large support.

    `slope` (3,): what one metre of depth changes in height is slope . (u, v, 1).
    """
    rows, cols = depth_m.shape
    out = np.zeros((rows, cols), np.int16)
    n = len(heights_m)
    for v in range(rows):
        for u in range(cols):
            z = depth_m[v, u]
            if z <= 0:
                continue
            i = int((points[v, u, 0] - origin_xy[0]) / RASTER_M)
            j = int((points[v, u, 1] - origin_xy[1]) / RASTER_M)
            if not (0 <= i < raster.shape[0] and 0 <= j < raster.shape[1]):
                continue
            bits = raster[i, j]
            if bits == 0:
                continue
            h = points[v, u, 2]
            rise = abs(slope[0] * u + slope[1] * v + slope[2])
            margin = max(low_m, 3.0 * depth_sigma(z) * rise)
            for k in range(n):
                if (bits >> np.uint64(k)) & np.uint64(1) == 0:
                    continue
                over = h - heights_m[k]
                if over > high_m:
                    break
                if over > margin:
                    out[v, u] = k + 1
                    break
                if over > -margin and large[k]:
                    out[v, u] = -1
                    break
    return out
