"""The loops of the search: every place against every reading."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.grid.occupancy import RESOLUTION_M as CELL_M
from afkb_mapping.kernels import kernel
from afkb_mapping.localisation.expectation import PLACE_M, TURNS
from afkb_mapping.localisation.rays import ray_in_plane, ray_in_space
from afkb_mapping.localisation.sensor_model import LASER_ROW, STEP_M, STEPS
from afkb_mapping.localisation.slabs import SLAB_M

Array = NDArray[np.float64]

BEYOND_M = 0.8
"""So far behind a reading all expectations are alike: four standard deviations at the farthest."""


@kernel
def scores_of(
    tried: NDArray[np.int64],
    places: NDArray[np.int64],
    index: NDArray[np.int32],
    steps: NDArray[np.uint8],
    origins_xyz: Array,
    origin: NDArray[np.int64],
    bearing: NDArray[np.int64],
    row: NDArray[np.int64],
    lines: NDArray[np.float32],
    off_map: float,
) -> NDArray[np.float32]:
    """(T, TURNS): summed log-likelihood with the base at each place tried, turned all around.

    `bearing`: (N,) in turns; `lines` (N, STEPS): log-likelihood of each reading by what is
    expected; `off_map`: that of one whose sensor would stand in something.
    """
    scores = np.zeros((len(tried), TURNS), np.float32)
    at = np.empty(len(origins_xyz), np.int64)
    for p in range(len(tried)):
        for turn in range(TURNS):
            yaw = turn * 2 * math.pi / TURNS
            _stand(at, places[tried[p]], index, origins_xyz, math.cos(yaw), math.sin(yaw))
            total = np.float32(0)
            for k in range(len(bearing)):
                q = at[origin[k]]
                if q < 0:
                    total += np.float32(off_map)
                    continue
                b = bearing[k] + turn
                if b >= TURNS:
                    b -= TURNS
                total += lines[k, steps[q, row[k], b]]
            scores[p, turn] = total
    return scores


@kernel
def _stand(
    at: NDArray[np.int64],
    place: NDArray[np.int64],
    index: NDArray[np.int32],
    origins_xyz: Array,
    c: float,
    s: float,
) -> None:
    """Set the place of each sensor, -1 where nothing is free, of a base that stands at a place."""
    for k in range(len(origins_xyz)):
        x, y = origins_xyz[k, 0], origins_xyz[k, 1]
        i = place[0] + math.floor((s * x + c * y) / PLACE_M + 0.5)
        j = place[1] + math.floor((c * x - s * y) / PLACE_M + 0.5)
        inside = 0 <= i < index.shape[0] and 0 <= j < index.shape[1]
        at[k] = index[i, j] if inside else -1


@kernel
def at_poses(
    poses: Array,
    at_laser: NDArray[np.uint8],
    in_space: NDArray[np.uint8],
    unseen: NDArray[np.bool_],
    origins_xyz: Array,
    origin: NDArray[np.int64],
    rays: Array,
    range_m: Array,
    row: NDArray[np.int64],
    lines: NDArray[np.float32],
    if_unseen: float,
) -> Array:
    """(N,): summed log-likelihood with the base at each pose: x, y (m, from the corner), yaw.

    `rays`: (N, 3) unit vectors in the base frame; `if_unseen`: least log-likelihood of a camera's
    reading that ends where nothing is known.
    """
    found = np.zeros(len(poses))
    for p in range(len(poses)):
        x, y, yaw = poses[p]
        c, s = math.cos(yaw), math.sin(yaw)
        for k in range(len(row)):
            ox, oy, oz = origins_xyz[origin[k]]
            x0, y0 = x + c * ox - s * oy, y + s * ox + c * oy
            dx, dy = c * rays[k, 0] - s * rays[k, 1], s * rays[k, 0] + c * rays[k, 1]
            farthest = range_m[k] + BEYOND_M
            if row[k] == LASER_ROW:
                reach = ray_in_plane(at_laser, x0, y0, dx, dy, farthest)
            else:
                reach = ray_in_space(in_space, x0, y0, oz, dx, dy, rays[k, 2], farthest)
            value = lines[k, min(int(reach / STEP_M + 0.5), STEPS - 1)]
            if value < if_unseen and row[k] != LASER_ROW and reach > range_m[k]:
                row_end = int((y0 + dy * range_m[k]) / CELL_M)
                col_end = int((x0 + dx * range_m[k]) / CELL_M)
                slab_end = int((oz + rays[k, 2] * range_m[k]) / SLAB_M)
                if _is_unseen(unseen, row_end, col_end, slab_end):
                    value = np.float32(if_unseen)
            found[p] += value
    return found


@kernel
def _is_unseen(unseen: NDArray[np.bool_], row: int, col: int, slab: int) -> bool:
    if not (0 <= row < unseen.shape[0] and 0 <= col < unseen.shape[1]):
        return True
    return bool(unseen[row, col, min(max(slab, 0), unseen.shape[2] - 1)])
