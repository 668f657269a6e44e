"""What a view reads of the distances around it, in its robot's own frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.geometry import yaw_of
from afkb_mapping.kernels import kernel
from afkb_mapping.localisation.sensor_model import (
    CLEAR,
    ELEVATIONS,
    FARTHEST_M,
    HIT,
    LASER_ROW,
)
from afkb_mapping.localisation.slabs import SLAB_M, SLABS
from afkb_mapping.panorama import NOISE_SIGMAS, STEP_OVER_M
from afkb_mapping.placing.odometry import IMAGE_FLOOR, step_covariance
from afkb_mapping.sensor_noise import depth_sigma

Array = NDArray[np.float64]

LASER_BEARINGS, CAMERA_BEARINGS = 360, 180
"""Directions all around: a degree is a cell at 3 m; a camera has its rows besides."""


@dataclass(frozen=True, slots=True, eq=False)
class Readings:
    """Distances (N,) that were read, and from where.

    - `origin`: (N,) index of the sensor's place in `origins_xyz` (M, 3), m, base frame.
    - `bearing`: (N,) rad, base frame. `range_m`: (N,), along the ray.
    - `row`: (N,) `LASER_ROW`, or 1 + index of the ray's elevation in `ELEVATIONS`.
    - `kind`: (N,) `HIT`, or `CLEAR` up to there.
    - `sigmas`: (3,) m, m, rad, by how much odometry errs between where the sensor's base stood and
      the frame of the readings.
    """

    origins_xyz: Array
    origin: NDArray[np.int64]
    bearing: Array
    range_m: Array
    row: NDArray[np.int64]
    kind: NDArray[np.int64]
    sigmas: Array = field(default_factory=lambda: np.array(IMAGE_FLOOR))

    def __len__(self) -> int:
        return len(self.bearing)

    def seen_from(self, T: Array) -> Readings:
        """The same readings in the frame in which odometry has their base at T (4, 4), level."""
        yaw = yaw_of(T)
        c, s = math.cos(yaw), math.sin(yaw)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        origins = self.origins_xyz @ turn + np.array([*T[:2, 3], 0.0])
        sigmas = np.hypot(IMAGE_FLOOR, np.sqrt(np.diag(step_covariance(T, np.eye(4)))))
        return replace(self, origins_xyz=origins, bearing=self.bearing + yaw, sigmas=sigmas)

    def rays(self) -> Array:
        """(N, 3) unit vectors along which was read, base frame."""
        up = np.concatenate([[0.0], ELEVATIONS])[self.row]
        flat = np.cos(up)
        return np.column_stack(
            [flat * np.cos(self.bearing), flat * np.sin(self.bearing), np.sin(up)]
        )

    def every(self, step: int) -> Readings:
        """Every step-th of them."""
        return Readings(
            self.origins_xyz,
            self.origin[::step],
            self.bearing[::step],
            self.range_m[::step],
            self.row[::step],
            self.kind[::step],
        )


def joined(parts: Sequence[Readings]) -> Readings:
    """All readings of several, which are in one frame."""
    offsets = np.cumsum([0, *(len(p.origins_xyz) for p in parts)])
    return Readings(
        np.concatenate([p.origins_xyz for p in parts]),
        np.concatenate([p.origin + o for p, o in zip(parts, offsets, strict=False)]),
        np.concatenate([p.bearing for p in parts]),
        np.concatenate([p.range_m for p in parts]),
        np.concatenate([p.row for p in parts]),
        np.concatenate([p.kind for p in parts]),
    )


def readings_of(view: View, T_level_base: Array) -> Readings:
    """What a view reads, in its base frame; at most one reading a direction.

    `T_level_base` (4, 4): the base in any level frame with z = 0 on the floor.
    """
    placed = replace(view, T_map_base=T_level_base)
    to_base = np.linalg.inv(_upright(T_level_base))
    parts = []
    if view.scan is not None:
        parts.append(_of_scan(placed, to_base @ placed.T_map_laser))
    if view.depth_m is not None:
        T = to_base @ placed.T_map_camera
        bearing, range_m, row, kind = _of_depth(view.depth_m, intrinsics_of(view), T, ELEVATIONS)
        parts.append(_from_one(T[:3, 3], bearing, range_m, row, kind))
    return joined(parts)


def _upright(T: Array) -> Array:
    """The frame on the floor below a base, turned as it is."""
    yaw = yaw_of(T)
    c, s = math.cos(yaw), math.sin(yaw)
    level = np.eye(4)
    level[:2, :2] = [[c, -s], [s, c]]
    level[:2, 3] = T[:2, 3]
    return level


def _from_one(
    origin_xyz: Array,
    bearing: Array,
    range_m: Array,
    row: NDArray[np.int64],
    kind: NDArray[np.int64],
) -> Readings:
    origin = np.zeros(len(bearing), np.int64)
    return Readings(origin_xyz.reshape(1, 3), origin, bearing, range_m, row, kind)


def _of_scan(view: View, T: Array) -> Readings:
    """The nearest of a laser's beams in each direction, none beyond `FARTHEST_M`."""
    assert view.scan is not None
    hit = view.scan.hit
    range_m = view.scan.ranges_m[hit].astype(np.float64)
    bearing = view.scan.angles[hit] + yaw_of(T)
    near = range_m < FARTHEST_M
    bearing, range_m = bearing[near], range_m[near]
    direction = np.floor(bearing / math.tau * LASER_BEARINGS).astype(np.int64) % LASER_BEARINGS
    order = np.lexsort((range_m, direction))
    first = order[np.unique(direction[order], return_index=True)[1]]
    row, kind = np.full(len(first), LASER_ROW), np.full(len(first), HIT)
    return _from_one(T[:3, 3], bearing[first], range_m[first], row, kind)


@kernel
def _of_depth(
    depth_m: NDArray[np.float32], intrinsics: Array, T: Array, elevations: Array
) -> tuple[Array, Array, NDArray[np.int64], NDArray[np.int64]]:
    """Bearing, range, row and kind (N,) of what a camera at T (4, 4) sees in each direction.

    Floor, and what is too far or too high, tells that the way there is clear.
    """
    fx, fy, cx, cy = intrinsics
    most = len(elevations) * CAMERA_BEARINGS
    bearing, range_m = np.empty(most), np.empty(most)
    row, kind = np.empty(most, np.int64), np.empty(most, np.int64)
    n = 0
    for b in range(CAMERA_BEARINGS):
        angle = (b + 0.5) * 2 * math.pi / CAMERA_BEARINGS
        for e in range(len(elevations)):
            up = math.sin(elevations[e])
            x, y = (
                math.cos(elevations[e]) * math.cos(angle),
                math.cos(elevations[e]) * math.sin(angle),
            )
            ahead = T[0, 2] * x + T[1, 2] * y + T[2, 2] * up
            if ahead <= 0.1:
                continue
            u = round(cx + fx * (T[0, 0] * x + T[1, 0] * y + T[2, 0] * up) / ahead)
            v = round(cy + fy * (T[0, 1] * x + T[1, 1] * y + T[2, 1] * up) / ahead)
            if not (0 <= u < depth_m.shape[1] and 0 <= v < depth_m.shape[0]):
                continue
            d = float(depth_m[v, u])
            if not d > 0.0:
                continue
            r = d / ahead
            height = T[2, 3] + r * up
            hit = height > max(STEP_OVER_M, NOISE_SIGMAS * depth_sigma(d))
            if r > FARTHEST_M:
                hit, r = False, FARTHEST_M
            if T[2, 3] + r * up > SLABS * SLAB_M:
                hit, r = False, max((SLABS * SLAB_M - T[2, 3]) / up, 0.0)
            bearing[n], range_m[n], row[n], kind[n] = angle, r, 1 + e, HIT if hit else CLEAR
            n += 1
    return bearing[:n], range_m[:n], row[:n], kind[:n]
