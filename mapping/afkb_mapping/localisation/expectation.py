"""What a sensor would read at each place of a map where a robot may be."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, distance_transform_edt

from afkb_mapping.grid.occupancy import RESOLUTION_M as CELL_M
from afkb_mapping.kernels import kernel
from afkb_mapping.localisation.bands import FREE, STANDS, UNKNOWN, HeightBands
from afkb_mapping.localisation.rays import CM, FARTHEST_M, ray_in_plane, ray_in_space
from afkb_mapping.localisation.sensor_model import ELEVATIONS, LASER_ROW, ROWS, STEP_M, STEPS
from afkb_mapping.localisation.slabs import SLAB_M, SLABS
from afkb_mapping.panorama import STEP_OVER_M

PLACE_M = 2 * CELL_M
"""Places are this far apart."""
TURNS = 180
"""Directions in which something is expected, and headings that are tried."""
STANDS_FREE_M = 0.10
"""Half the width of the smallest robots: nobody stands nearer to a wall."""
OVERHANG_M = 0.30
"""A camera reaches so far over what the robot stands before, a bed or a table."""
LOW_M, SHIN_M = (0.10, 1.0), (0.15, 0.45)
"""Where a robot drives nothing stands at these heights; a laser looks at some of the second."""


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """How far from each cell the nearest thing stands, in `CM`, uint8 (at most 255).

    - `at_laser` (rows, cols): of what the laser meets. `in_space` (rows, cols, SLABS): of all.
    - `places` (P, 2): row and column, in cells of `PLACE_M`, of where sensors may be; `index`
      (rows / 2, cols / 2) their numbers, -1 for none; `stand` numbers of those where a base fits.
    - `unseen` (rows, cols, SLABS): of what is there, nothing is known.
    """

    origin_xy: NDArray[np.float64]
    at_laser: NDArray[np.uint8]
    in_space: NDArray[np.uint8]
    places: NDArray[np.int64]
    index: NDArray[np.int32]
    stand: NDArray[np.int64]
    unseen: NDArray[np.bool_]


def surroundings_of(bands: HeightBands) -> Surroundings:
    """What the map holds, as rays look at it; no places where none of it is known to be free."""
    laser, depth = (bands.scan != UNKNOWN).any(), (bands.slabs != UNKNOWN).any()
    solid = bands.slabs == STANDS
    solid[..., : round(STEP_OVER_M / SLAB_M)] = False  # the floor
    if not depth:  # what a laser meets is taken for walls
        solid = np.repeat((bands.scan == STANDS)[..., None], SLABS, axis=2)
    low, shin = (solid[..., round(a / SLAB_M) : round(b / SLAB_M)] for a, b in (LOW_M, SHIN_M))
    at_laser = np.asarray(bands.scan == STANDS if laser else shin.any(axis=2), np.bool_)
    seen_free = (bands.slabs[..., : round(LOW_M[1] / SLAB_M)] == FREE).any(axis=2)
    free = np.asarray(bands.scan == FREE if laser else seen_free & ~low.any(axis=2), np.bool_)
    room = distance_transform_edt(np.pad(free, 1))[1:-1, 1:-1] * CELL_M
    is_place = binary_dilation(_coarser(free), iterations=round(OVERHANG_M / PLACE_M))
    fits = _coarser(room > STANDS_FREE_M)
    places = np.argwhere(is_place).astype(np.int64)
    index = np.full(is_place.shape, -1, np.int32)
    index[is_place] = np.arange(len(places))
    return Surroundings(
        bands.origin_xy,
        _distance(at_laser, (CELL_M, CELL_M)),
        _distance(solid, (CELL_M, CELL_M, SLAB_M)),
        places,
        index,
        np.flatnonzero(fits[is_place]),
        np.asarray(bands.slabs == UNKNOWN, np.bool_),
    )


def _coarser(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    rows, cols = (n // 2 for n in cells.shape)
    blocks = cells[: 2 * rows, : 2 * cols].reshape(rows, 2, cols, 2)
    return np.asarray(blocks.any(axis=(1, 3)), np.bool_)


def _distance(solid: NDArray[np.bool_], cell_m: tuple[float, ...]) -> NDArray[np.uint8]:
    if not solid.any():
        return np.full(solid.shape, 255, np.uint8)
    apart = distance_transform_edt(~solid, sampling=cell_m)
    kept: NDArray[np.uint8] = np.minimum(apart / CM, 255).astype(np.uint8)
    return kept


class Expectation:
    """What is read all around from each place: by a laser, and by a camera at one height."""

    def __init__(self, around: Surroundings, eye_m: float) -> None:
        self.around = around
        self.steps = np.zeros((len(around.places), ROWS, TURNS), np.uint8)
        """(P, ROWS, TURNS): distance in steps of `STEP_M`, at most `STEPS` - 1."""
        self._eye_m = eye_m
        self._known: set[int] = set()

    def know(self, rows: NDArray[np.int64]) -> None:
        """Look along these rows, if that has not been done."""
        for row in sorted(set(rows.tolist()) - self._known):
            if row == LASER_ROW:
                _look_in_plane(self.steps, self.around.at_laser, self.around.places)
            else:
                up = math.tan(ELEVATIONS[row - 1])
                space, places = self.around.in_space, self.around.places
                _look_in_space(self.steps, row, space, places, self._eye_m, up)
            self._known.add(row)


@kernel
def _look_in_plane(
    steps: NDArray[np.uint8], at_laser: NDArray[np.uint8], places: NDArray[np.int64]
) -> None:
    for p in range(len(places)):
        x, y = (places[p, 1] + 0.5) * PLACE_M, (places[p, 0] + 0.5) * PLACE_M
        for k in range(TURNS):
            angle = (k + 0.5) * 2 * math.pi / TURNS
            along_x, along_y = math.cos(angle), math.sin(angle)
            reach = ray_in_plane(at_laser, x, y, along_x, along_y, FARTHEST_M)
            steps[p, 0, k] = min(int(reach / STEP_M + 0.5), STEPS - 1)


@kernel
def _look_in_space(
    steps: NDArray[np.uint8],
    row: int,
    in_space: NDArray[np.uint8],
    places: NDArray[np.int64],
    eye_m: float,
    slope: float,
) -> None:
    flat = 1 / math.sqrt(1 + slope * slope)
    for p in range(len(places)):
        x, y = (places[p, 1] + 0.5) * PLACE_M, (places[p, 0] + 0.5) * PLACE_M
        for k in range(TURNS):
            angle = (k + 0.5) * 2 * math.pi / TURNS
            along_x, along_y = flat * math.cos(angle), flat * math.sin(angle)
            reach = ray_in_space(in_space, x, y, eye_m, along_x, along_y, flat * slope, FARTHEST_M)
            steps[p, row, k] = min(int(reach / STEP_M + 0.5), STEPS - 1)
