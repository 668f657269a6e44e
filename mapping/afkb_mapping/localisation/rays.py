"""How far a ray goes until it meets something: sphere tracing through distances."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.grid.occupancy import RESOLUTION_M as CELL_M
from afkb_mapping.kernels import kernel
from afkb_mapping.localisation.sensor_model import STEP_M, STEPS
from afkb_mapping.localisation.slabs import SLAB_M
from afkb_mapping.panorama import STEP_OVER_M

CM = 0.01
"""Distances are kept in this unit."""
FARTHEST_M = STEPS * STEP_M
CORNER_M = 0.07
"""From the middle of a cell to the farthest point of a neighbour that it touches."""
SHORTEST_M = CELL_M / 2


@kernel
def ray_in_plane(
    apart: NDArray[np.uint8],
    x: float,
    y: float,
    along_x: float,
    along_y: float,
    farthest: float,
) -> float:
    """Distance, m, from a point (m, from the grid's corner) to what stands in a direction.

    `apart` (rows, cols): `CM` from each cell to the nearest thing. Each step goes as far as nothing
    can stand. A ray that meets nothing gives `FARTHEST_M`, and so does one that gets farther than
    `farthest`, m.
    """
    reach = 0.0
    while reach < farthest:
        i, j = int((y + along_y * reach) / CELL_M), int((x + along_x * reach) / CELL_M)
        if not (0 <= i < apart.shape[0] and 0 <= j < apart.shape[1]):
            return FARTHEST_M
        if apart[i, j] == 0:
            return reach
        reach += max(apart[i, j] * CM - CORNER_M, SHORTEST_M)
    return FARTHEST_M


@kernel
def ray_in_space(
    apart: NDArray[np.uint8],
    x: float,
    y: float,
    z: float,
    along_x: float,
    along_y: float,
    along_z: float,
    farthest: float,
) -> float:
    """The same in three dimensions; `apart` (rows, cols, SLABS), z above the floor, m.

    What reaches the floor, or leaves the slabs, meets nothing.
    """
    reach = 0.0
    while reach < farthest:
        height = z + along_z * reach
        s = int(height / SLAB_M)
        if height <= STEP_OVER_M or (s >= apart.shape[2] and along_z >= 0):
            return FARTHEST_M
        i, j = int((y + along_y * reach) / CELL_M), int((x + along_x * reach) / CELL_M)
        if not (0 <= i < apart.shape[0] and 0 <= j < apart.shape[1]):
            return FARTHEST_M
        if s >= apart.shape[2]:  # a camera above all that is known looks down
            reach += SHORTEST_M
            continue
        if apart[i, j, s] == 0:
            return reach
        reach += max(apart[i, j, s] * CM - CORNER_M, SHORTEST_M)
    return FARTHEST_M
