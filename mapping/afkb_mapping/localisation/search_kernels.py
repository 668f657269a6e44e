"""The loops of the search: every place against every reading."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.localisation.expectation import CELL_M, ray
from afkb_mapping.localisation.readings import BEARINGS
from afkb_mapping.localisation.sensor_model import STEP_M, STEPS

Array = NDArray[np.float64]

BEARING_STEP = 2
"""Headings are first tried two degrees apart."""
OFF_MAP = -1.5
"""Log-likelihood of each reading of a sensor that would stand in a wall."""


@kernel
def scores_of(
    tried: NDArray[np.intp],
    places: NDArray[np.int64],
    index: NDArray[np.int32],
    steps: NDArray[np.uint8],
    origins_xy: Array,
    origin: NDArray[np.int64],
    bearing: NDArray[np.int64],
    reading: NDArray[np.int64],
    band: NDArray[np.int64],
    kind: NDArray[np.int64],
    table: NDArray[np.float32],
) -> NDArray[np.float32]:
    """(T, turns): summed log-likelihood with the base at each place tried, turned all around."""
    turns = BEARINGS // BEARING_STEP
    scores = np.zeros((len(tried), turns), np.float32)
    at = np.empty(len(origins_xy), np.int64)
    for turn in range(turns):
        ahead = turn * BEARING_STEP
        yaw = ahead * 2 * math.pi / BEARINGS
        for p in range(len(tried)):
            _stand(at, places[tried[p]], index, origins_xy, math.cos(yaw), math.sin(yaw))
            total = np.float32(0)
            for k in range(len(bearing)):
                q = at[origin[k]]
                if q < 0:
                    total += np.float32(OFF_MAP)
                    continue
                b = bearing[k] + ahead
                if b >= BEARINGS:
                    b -= BEARINGS
                total += table[band[k], kind[k], reading[k], steps[q, band[k], b]]
            scores[p, turn] = total
    return scores


@kernel
def _stand(
    at: NDArray[np.int64],
    place: NDArray[np.int64],
    index: NDArray[np.int32],
    origins_xy: Array,
    c: float,
    s: float,
) -> None:
    """Set the place of each sensor, -1 where nobody can stand, of a base that stands at a place."""
    for k in range(len(origins_xy)):
        x, y = origins_xy[k, 0], origins_xy[k, 1]
        i = place[0] + math.floor((s * x + c * y) / CELL_M + 0.5)
        j = place[1] + math.floor((c * x - s * y) / CELL_M + 0.5)
        inside = 0 <= i < index.shape[0] and 0 <= j < index.shape[1]
        at[k] = index[i, j] if inside else -1


@kernel
def at_poses(
    poses: Array,
    distance_m: NDArray[np.float32],
    origins_xy: Array,
    origin: NDArray[np.int64],
    bearing: Array,
    reading: NDArray[np.int64],
    band: NDArray[np.int64],
    kind: NDArray[np.int64],
    table: NDArray[np.float32],
) -> Array:
    """(N,): summed log-likelihood with the base at each pose: x, y (m, from the corner), yaw."""
    found = np.zeros(len(poses))
    for p in range(len(poses)):
        x, y, yaw = poses[p]
        c, s = math.cos(yaw), math.sin(yaw)
        for k in range(len(bearing)):
            ox, oy = origins_xy[origin[k], 0], origins_xy[origin[k], 1]
            angle = bearing[k] + yaw
            reach = ray(
                distance_m[band[k]],
                x + c * ox - s * oy,
                y + s * ox + c * oy,
                math.cos(angle),
                math.sin(angle),
            )
            step = min(int(reach / STEP_M + 0.5), STEPS - 1)
            found[p] += table[band[k], kind[k], reading[k], step]
    return found
