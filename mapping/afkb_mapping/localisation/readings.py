"""What a view reads of the distances around it, in its robot's own frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.geometry import yaw_of
from afkb_mapping.localisation.bands import ANY, SCAN, TALL
from afkb_mapping.localisation.sensor_model import CLEAR, FARTHEST_M, HIT
from afkb_mapping.panorama import Panorama, panorama_of

Array = NDArray[np.float64]

BEARINGS = 360
"""Directions all around: a degree each is a cell at 3 m."""


@dataclass(frozen=True, slots=True, eq=False)
class Readings:
    """Distances (N,) that were read, and from where.

    - `origin`: (N,) index of the sensor's place in `origins_xy` (M, 2), m, base frame.
    - `bearing`: (N,) rad, base frame. `range_m`: (N,).
    - `band`: (N,) height band that was looked at; `kind`: (N,) `HIT` or `CLEAR` up to there.
    """

    origins_xy: Array
    origin: NDArray[np.int64]
    bearing: Array
    range_m: Array
    band: NDArray[np.int64]
    kind: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.bearing)

    def seen_from(self, T: Array) -> Readings:
        """The same readings in the frame in which their base stands at T (4, 4), level."""
        yaw = yaw_of(T)
        c, s = math.cos(yaw), math.sin(yaw)
        origins = self.origins_xy @ np.array([[c, s], [-s, c]]) + T[:2, 3]
        return Readings(
            origins, self.origin, self.bearing + yaw, self.range_m, self.band, self.kind
        )


def joined(parts: Sequence[Readings]) -> Readings:
    """All readings of several, which are in one frame."""
    offsets = np.cumsum([0, *(len(p.origins_xy) for p in parts)])
    return Readings(
        np.concatenate([p.origins_xy for p in parts]),
        np.concatenate([p.origin + o for p, o in zip(parts, offsets, strict=False)]),
        np.concatenate([p.bearing for p in parts]),
        np.concatenate([p.range_m for p in parts]),
        np.concatenate([p.band for p in parts]),
        np.concatenate([p.kind for p in parts]),
    )


def readings_of(view: View, T_level_base: Array) -> Readings:
    """What a view reads, in its base frame; at most one reading a band and degree.

    `T_level_base` (4, 4): the base in any level frame with z = 0 on the floor.
    """
    placed = replace(view, T_map_base=T_level_base)
    yaw = yaw_of(T_level_base)
    parts = []
    if view.scan is not None:
        T = np.linalg.inv(T_level_base) @ placed.T_map_laser
        hit = view.scan.hit
        bearing = view.scan.angles[hit] + yaw_of(T)
        ranges = view.scan.ranges_m[hit].astype(np.float64)
        parts.append(_thinned(T[:2, 3], bearing, ranges, SCAN, HIT))
    panorama = panorama_of(placed)
    if panorama is not None:
        parts += _of_depth(panorama, placed.T_map_camera, T_level_base, yaw)
    return joined(parts)


def _of_depth(panorama: Panorama, T_camera: Array, T_base: Array, yaw: float) -> list[Readings]:
    eye = (np.linalg.inv(T_base) @ T_camera)[:2, 3]
    bearing = panorama.bearings - yaw
    met, clear = np.isfinite(panorama.obstacle_m), panorama.free_m > 0
    only_clear = clear & ~met
    tall = np.isfinite(panorama.tall_m)
    return [
        _thinned(eye, bearing[met], panorama.obstacle_m[met], ANY, HIT),
        _thinned(eye, bearing[only_clear], panorama.free_m[only_clear], ANY, CLEAR),
        _thinned(eye, bearing[tall], panorama.tall_m[tall], TALL, HIT),
    ]


def _thinned(origin_xy: Array, bearing: Array, range_m: Array, band: int, kind: int) -> Readings:
    """The nearest in each direction; none beyond `FARTHEST_M`."""
    near = range_m < FARTHEST_M
    bearing, range_m = bearing[near], range_m[near]
    direction = np.floor(bearing / (2 * math.pi) * BEARINGS).astype(np.int64) % BEARINGS
    order = np.lexsort((range_m, direction))
    first = order[np.unique(direction[order], return_index=True)[1]]
    n = len(first)
    return Readings(
        origin_xy.reshape(1, 2),
        np.zeros(n, np.int64),
        bearing[first],
        range_m[first],
        np.full(n, band, np.int64),
        np.full(n, kind, np.int64),
    )
