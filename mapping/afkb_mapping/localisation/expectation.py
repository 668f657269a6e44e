"""What a sensor would read at each place of a map where a robot may stand."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from afkb_mapping.kernels import kernel
from afkb_mapping.localisation.bands import ANY, BANDS, SCAN, TALL, UNKNOWN, HeightBands
from afkb_mapping.localisation.readings import BEARINGS
from afkb_mapping.localisation.sensor_model import STEP_M, STEPS
from afkb_mapping.occupancy import RESOLUTION_M

CELL_M = 2 * RESOLUTION_M
"""Places to stand are tried this far apart."""
STANDS_FREE_M = 0.10
"""Half the width of the smallest robots: nobody stands nearer to a wall."""


@dataclass(frozen=True, slots=True, eq=False)
class Expectation:
    """Distances that are to be read, by place, band and direction.

    - `distance_m` (BANDS, rows, cols): from each cell of the bands to what stands there.
    - `places` (P, 2): row and column, in cells of `CELL_M`, of where a robot may stand.
    - `index` (rows / 2, cols / 2): of the place in a cell, -1 for none.
    - `steps` (P, BANDS, BEARINGS) uint8: distance in steps of `STEP_M`, at most `STEPS` - 1.
    """

    origin_xy: NDArray[np.float64]
    distance_m: NDArray[np.float32]
    places: NDArray[np.int64]
    index: NDArray[np.int32]
    steps: NDArray[np.uint8]


def expectation_of(bands: HeightBands) -> Expectation:
    """What the map lets a robot expect; no places where none of it is known to be free."""
    scan, any_ = bands.stands(SCAN), bands.stands(ANY) | bands.stands(SCAN)
    has_scan = bool((bands.occupancy[SCAN] != UNKNOWN).any())
    # a map made without a laser is held against a laser as best it can be
    blocked = (scan if has_scan else any_, any_, bands.stands(TALL))
    distance_m = np.stack([_distance(b) for b in blocked]).astype(np.float32)
    free = _free(bands, SCAN) if has_scan else _free(bands, ANY)
    room = distance_transform_edt(np.pad(free, 1))[1:-1, 1:-1] * RESOLUTION_M > STANDS_FREE_M
    rows, cols = (n // 2 for n in room.shape)
    may_stand = room[: 2 * rows, : 2 * cols].reshape(rows, 2, cols, 2).any(axis=(1, 3))
    places = np.argwhere(may_stand)
    index = np.full((rows, cols), -1, np.int32)
    index[may_stand] = np.arange(len(places))
    return Expectation(
        bands.origin_xy, distance_m, places, index, _ranges(distance_m, places.astype(np.int64))
    )


def _free(bands: HeightBands, band: int) -> NDArray[np.bool_]:
    occupancy = bands.occupancy[band]
    free: NDArray[np.bool_] = (occupancy != UNKNOWN) & (occupancy < 50)
    return free


def _distance(blocked: NDArray[np.bool_]) -> NDArray[np.float64]:
    if not blocked.any():
        return np.full(blocked.shape, STEPS * STEP_M)
    distance: NDArray[np.float64] = distance_transform_edt(~blocked) * RESOLUTION_M
    return distance


@kernel
def _ranges(distance_m: NDArray[np.float32], places: NDArray[np.int64]) -> NDArray[np.uint8]:
    out = np.empty((len(places), BANDS, BEARINGS), np.uint8)
    for p in range(len(places)):
        x, y = (places[p, 1] + 0.5) * CELL_M, (places[p, 0] + 0.5) * CELL_M
        for k in range(BEARINGS):
            angle = (k + 0.5) * 2 * math.pi / BEARINGS
            for band in range(BANDS):
                reach = ray(distance_m[band], x, y, math.cos(angle), math.sin(angle))
                out[p, band, k] = min(int(reach / STEP_M + 0.5), STEPS - 1)
    return out


@kernel
def ray(
    distance_m: NDArray[np.float32], x: float, y: float, along_x: float, along_y: float
) -> float:
    """Distance, m, from a point (m, from the bands' corner) to what stands in a direction.

    Sphere tracing: each step goes as far as nothing can stand.
    """
    reach, farthest = 0.0, STEPS * STEP_M
    while reach < farthest:
        j = int((x + along_x * reach) / RESOLUTION_M)
        i = int((y + along_y * reach) / RESOLUTION_M)
        if not (0 <= i < distance_m.shape[0] and 0 <= j < distance_m.shape[1]):
            return farthest
        apart = distance_m[i, j]
        if apart <= 0:
            return reach
        reach += max(apart - RESOLUTION_M, 0.5 * RESOLUTION_M)
    return farthest
