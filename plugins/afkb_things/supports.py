"""Where, seen from above, a view's supports and walls are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.bodies import supports_among
from afkb_mapping.from_above import hull_candidates, reach_xy
from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

RASTER_M = 0.02
HULL_MARGIN_CELLS = 1
LARGE_SUPPORT_M2 = 0.12
WALL_BIT = np.uint64(63)
WALL_HEIGHT_M, WALL_LENGTH_M = 1.0, 1.0
WALL_RMS_M = 0.05
WALL_SIGMAS = 3.0


@dataclass(frozen=True, slots=True, eq=False)
class Supports:
    """Supports of a view, highest first, and a raster of which of them lie under a spot.

    `raster`: (X, Y) uint64, bit k for support k; its corner is at `origin_xy`.
    """

    detections: tuple[Detection, ...]
    heights_m: NDArray[np.float64]
    areas_m2: NDArray[np.float64]
    large: NDArray[np.bool_]
    raster: NDArray[np.uint64]
    origin_xy: NDArray[np.float64]

    @classmethod
    def of(
        cls, earlier: Sequence[Detection], camera_xyz: NDArray[np.float64], noise: float
    ) -> Supports:
        """The supports among a view's detections, the floor left out.

        The depth of a view from `camera_xyz` is `noise` times as noisy as the sensor's model says.
        """
        chosen = supports_among(earlier)
        heights = np.array([float(d.position_xyz[2]) for d in chosen])
        areas = np.array([d.measures.get("area", 0.0) for d in chosen])
        walls = [d.segment_xy for d in earlier if d.segment_xy is not None and _is_wall(d)]
        raster, origin = _raster(chosen, walls)
        for segment in walls:
            _mark_wall(raster, origin, segment, camera_xyz, noise)
        return cls(tuple(chosen), heights, areas, areas >= LARGE_SUPPORT_M2, raster, origin)


def _raster(
    chosen: Sequence[Detection], walls_xy: Sequence[NDArray[np.float64]]
) -> tuple[NDArray[np.uint64], NDArray[np.float64]]:
    """Supports' hulls as bits of a grid that reaches as far as they and the walls do."""
    hulls = [reach_xy(d.footprint_xy) for d in chosen]
    reach = np.array([*hulls, *(reach_xy(segment) for segment in walls_xy)]).reshape(-1, 2, 2)
    if not len(reach):
        return np.zeros((1, 1), np.uint64), np.zeros(2)
    pad = (HULL_MARGIN_CELLS + 2) * RASTER_M
    origin, far = reach[:, 0].min(axis=0) - pad, reach[:, 1].max(axis=0) + pad
    shape = np.ceil((far - origin) / RASTER_M).astype(int) + 1
    raster = np.zeros((int(shape[0]), int(shape[1])), np.uint64)
    margin = np.ones((2 * HULL_MARGIN_CELLS + 1,) * 2, np.uint8)
    for k, d in enumerate(chosen):
        ij = np.floor((d.footprint_xy - origin) / RASTER_M).astype(np.int32)
        first, last = np.floor((hulls[k] - origin) / RASTER_M).astype(np.int32)
        low = first - HULL_MARGIN_CELLS
        size = last - low + 1 + HULL_MARGIN_CELLS
        mask = np.zeros((int(size[0]), int(size[1])), np.uint8)
        hull = cv2.convexHull(hull_candidates((ij - low)[:, ::-1]).astype(np.int32))
        cv2.fillConvexPoly(mask, hull, 1)
        mask = cv2.dilate(mask, margin)
        _set_bit(raster[low[0] : low[0] + size[0], low[1] : low[1] + size[1]], mask, np.uint64(k))
    return raster, origin


def _is_wall(bound: Detection) -> bool:
    """Whether an upright plane is one plane, and larger than the side of a bin or a carton."""
    length = bound.measures.get("length", 0.0)
    large = length >= WALL_LENGTH_M or bound.measures.get("height", 0.0) >= WALL_HEIGHT_M
    return large and bound.measures.get("rms", 0.0) < WALL_RMS_M


@kernel
def _mark_wall(
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
    ends_xy: NDArray[np.float64],
    camera_xyz: NDArray[np.float64],
    noise: float,
) -> None:
    """Set the wall bit where an upright plane stands, so that it isn't a thing on a support.

    As far to either side as noise may put what is seen of it: noise goes along sight lines.
    """
    along = ends_xy[1] - ends_xy[0]
    length = max(math.hypot(along[0], along[1]), RASTER_M)
    steps = int(length / (0.5 * RASTER_M)) + 1
    for n in range(steps + 1):
        x, y = ends_xy[0, 0] + along[0] * n / steps, ends_xy[0, 1] + along[1] * n / steps
        to_x, to_y = x - camera_xyz[0], y - camera_xyz[1]
        far = max(math.hypot(to_x, to_y), RASTER_M)
        facing = abs(to_x * along[1] - to_y * along[0]) / (far * length)
        off = WALL_SIGMAS * noise * depth_sigma(far) * facing
        reach = 1 + int(off / RASTER_M)
        i, j = int((x - origin_xy[0]) / RASTER_M), int((y - origin_xy[1]) / RASTER_M)
        for a in range(max(i - reach, 0), min(i + reach + 1, raster.shape[0])):
            for b in range(max(j - reach, 0), min(j + reach + 1, raster.shape[1])):
                raster[a, b] |= np.uint64(1) << WALL_BIT


@kernel
def _set_bit(raster: NDArray[np.uint64], mask: NDArray[np.uint8], bit: np.uint64) -> None:
    """Set a bit wherever the mask is 1."""
    for i in range(raster.shape[0]):
        for j in range(raster.shape[1]):
            raster[i, j] |= np.uint64(mask[i, j]) << bit
