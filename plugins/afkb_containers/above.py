"""Which pixels show something that stands on which support."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.sensor_noise import depth_sigma

RASTER_M = 0.02
HULL_MARGIN_CELLS = 1
LARGE_SUPPORT_M2 = 0.12
MAX_SUPPORTS = 62
WALL_BIT = np.uint64(63)
ON_WALL = -2
FLOOR_M = 0.03
WALL_HEIGHT_M, WALL_LENGTH_M = 1.0, 1.0
WALL_RMS_M = 0.05
WALL_CELLS = 3
MAX_SLOPE = 0.05


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
        raster, origin = _raster(chosen, earlier)
        for d in earlier:
            if d.segment_xy is not None and _is_wall(d):
                _mark_wall(raster, origin, d.segment_xy)
        return cls(tuple(chosen), heights, areas >= LARGE_SUPPORT_M2, raster, origin)


def _raster(
    chosen: Sequence[Detection], earlier: Sequence[Detection]
) -> tuple[NDArray[np.uint64], NDArray[np.float64]]:
    """Supports' hulls as bits of a grid that reaches as far as anything that was detected."""
    reach = [d.footprint_xy for d in earlier if len(d.footprint_xy)]
    if not reach:
        return np.zeros((1, 1), np.uint64), np.zeros(2)
    pad = (HULL_MARGIN_CELLS + 2) * RASTER_M
    origin = np.min([xy.min(axis=0) for xy in reach], axis=0) - pad
    far = np.max([xy.max(axis=0) for xy in reach], axis=0) + pad
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


def _is_wall(bound: Detection) -> bool:
    """Whether an upright plane is one plane, and larger than the side of a bin or a carton."""
    length = bound.measures.get("length", 0.0)
    large = length >= WALL_LENGTH_M or bound.measures.get("height", 0.0) >= WALL_HEIGHT_M
    return large and bound.measures.get("rms", 0.0) < WALL_RMS_M


def _mark_wall(
    raster: NDArray[np.uint64], origin: NDArray[np.float64], segment_xy: NDArray[np.float64]
) -> None:
    """Set the wall bit where an upright plane stands, so that it isn't a thing on a support."""
    mask = np.zeros(raster.shape, np.uint8)
    ends = np.floor((segment_xy - origin) / RASTER_M).astype(int)[:, ::-1]
    cv2.line(mask, tuple(ends[0].tolist()), tuple(ends[1].tolist()), 1, WALL_CELLS)
    raster |= mask.astype(np.uint64) << WALL_BIT


@njit(cache=True)
def fit_supports(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    heights_m: NDArray[np.float64],
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Plane of each support (K, 3): its height is a x + b y + c, x and y from the raster's corner.

    Poses that are tilted by a degree lift the far end of a table by more than a magazine.
    """
    n = len(heights_m)
    planes = np.zeros((n, 3))
    planes[:, 2] = heights_m
    for near in (0.020, 0.010):
        moments = np.zeros((n, 3, 3))
        right = np.zeros((n, 3))
        for v in range(0, depth_m.shape[0], 2):
            for u in range(0, depth_m.shape[1], 2):
                if depth_m[v, u] <= 0:
                    continue
                x, y = points[v, u, 0] - origin_xy[0], points[v, u, 1] - origin_xy[1]
                i, j = int(x / RASTER_M), int(y / RASTER_M)
                if not (0 <= i < raster.shape[0] and 0 <= j < raster.shape[1]):
                    continue
                bits = raster[i, j]
                for k in range(n):
                    if (bits >> np.uint64(k)) & np.uint64(1) == 0:
                        continue
                    h = points[v, u, 2]
                    if abs(h - (planes[k, 0] * x + planes[k, 1] * y + planes[k, 2])) < near:
                        row = (x, y, 1.0)
                        for r in range(3):
                            right[k, r] += row[r] * h
                            for c in range(3):
                                moments[k, r, c] += row[r] * row[c]
        for k in range(n):
            if moments[k, 2, 2] > 30:
                m = moments[k]
                weight = m[2, 2]
                # a slope that noise alone could give is held at level
                m[0, 0] += 0.002 * weight
                m[1, 1] += 0.002 * weight
                mx, my = m[0, 2] / weight, m[1, 2] / weight
                m[0, 0] -= weight * mx * mx
                m[1, 1] -= weight * my * my
                mxy = m[0, 1] - weight * mx * my
                mh = right[k, 2] / weight
                rx, ry = right[k, 0] - weight * mx * mh, right[k, 1] - weight * my * mh
                det = m[0, 0] * m[1, 1] - mxy * mxy
                a = (rx * m[1, 1] - ry * mxy) / det
                b = (ry * m[0, 0] - rx * mxy) / det
                if a * a + b * b < MAX_SLOPE * MAX_SLOPE:
                    planes[k, 0], planes[k, 1], planes[k, 2] = a, b, mh - a * mx - b * my
    return planes


@njit(cache=True)
def label_things(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    planes: NDArray[np.float64],
    large: NDArray[np.bool_],
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
    slope: NDArray[np.float64],
    low_m: float,
    high_m: float,
) -> tuple[NDArray[np.int16], NDArray[np.float32]]:
    """Say which support each pixel's point stands on, from 1, and how high over it.

    Returns labels (H, W), 0 where there is none, -1 on a support or the floor itself, ON_WALL on
    an upright plane; and heights over the support (H, W) float32, m.

    `slope` (3,): what one metre of depth changes in height is slope . (u, v, 1).
    """
    rows, cols = depth_m.shape
    out = np.zeros((rows, cols), np.int16)
    overs = np.zeros((rows, cols), np.float32)
    n = len(planes)
    for v in range(rows):
        for u in range(cols):
            z = depth_m[v, u]
            if z <= 0:
                continue
            x, y = points[v, u, 0] - origin_xy[0], points[v, u, 1] - origin_xy[1]
            i, j = int(x / RASTER_M), int(y / RASTER_M)
            if points[v, u, 2] < FLOOR_M:
                out[v, u] = -1
                continue
            if not (0 <= i < raster.shape[0] and 0 <= j < raster.shape[1]):
                continue
            bits = raster[i, j]
            if bits >> WALL_BIT != 0:
                out[v, u] = ON_WALL
                continue
            if bits == 0:
                continue
            h = points[v, u, 2]
            rise = abs(slope[0] * u + slope[1] * v + slope[2])
            margin = max(low_m, 3.0 * depth_sigma(z) * rise)
            for k in range(n):
                if (bits >> np.uint64(k)) & np.uint64(1) == 0:
                    continue
                over = h - (planes[k, 0] * x + planes[k, 1] * y + planes[k, 2])
                if over > high_m:
                    break
                if over > margin:
                    out[v, u] = k + 1
                    overs[v, u] = over
                    break
                if over > -margin:
                    out[v, u] = -1
                    if large[k]:
                        break
    return out, overs
