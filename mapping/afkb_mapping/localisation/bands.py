"""What stands where, by height: what a view is held against when a robot asks where it is.

A laser sees one height, a depth camera all. A chair that is moved hides nothing of the wall above
it, and a table top has a height that a wall has not. So there is one grid for what the laser meets
and one for each slab of height that depth images show.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb.flow import View
from afkb_mapping.geometry import transform_xy
from afkb_mapping.grid.occupancy import RESOLUTION_M as CELL_M
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.localisation.slabs import SLABS, SlabBuilder

STATE_FILE = "bands.npz"
"""In the map's `state/`: `scan` (rows, cols), `slabs` (rows, cols, SLABS), int8; `origin_xy`."""
UNKNOWN, FREE, STANDS = -1, 0, 1


@dataclass(frozen=True, slots=True, eq=False)
class HeightBands:
    """What is `UNKNOWN`, `FREE` or where something `STANDS`, int8.

    - `scan` (rows, cols): at the height of the laser.
    - `slabs` (rows, cols, SLABS): in each slab of height, the lowest on the floor.
    - `origin_xy` (2,): lower left corner of cell (0, 0), m, map frame; rows run along +y, cells
      are `CELL_M` wide.
    """

    scan: NDArray[np.int8]
    slabs: NDArray[np.int8]
    origin_xy: NDArray[np.float64]

    def to_bytes(self) -> bytes:
        """The content of `STATE_FILE`; the same for the same bands."""
        file = io.BytesIO()
        np.savez_compressed(file, scan=self.scan, slabs=self.slabs, origin_xy=self.origin_xy)
        return file.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes) -> HeightBands:
        """Raises `MapError` where the content is not what `to_bytes` gives."""
        try:
            with np.load(io.BytesIO(content), allow_pickle=False) as stored:
                scan, slabs, origin_xy = stored["scan"], stored["slabs"], stored["origin_xy"]
        except (ValueError, OSError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise MapError(f"state/{STATE_FILE}: not readable ({error}); map again") from error
        if scan.ndim != 2 or slabs.shape != (*scan.shape, SLABS) or origin_xy.shape != (2,):
            raise MapError(f"state/{STATE_FILE}: not the height bands of a map; map again")
        return cls(scan.astype(np.int8), slabs.astype(np.int8), origin_xy.astype(np.float64))


class BandBuilder:
    """Builds the bands view by view; they grow with the area that is seen, not with time."""

    def __init__(self) -> None:
        self._scan = GridBuilder()
        self._slabs = SlabBuilder()

    def add(self, view: View) -> None:
        """Take in a view that is placed in the map frame."""
        if view.scan is not None:
            T = view.T_map_laser
            ends = transform_xy(T, view.scan.points_xy)
            self._scan.insert_beams(T[:2, 3], ends, np.ones(len(ends), np.bool_))
        if view.depth_m is not None:
            self._slabs.insert(view)

    def bands(self) -> HeightBands:
        """What was seen so far; one unknown cell where nothing was."""
        grid = self._scan.grid()
        scan = _states(np.nan_to_num(grid.probability - 0.5), np.isfinite(grid.probability))
        slabs, first_cell = self._slabs.slabs()
        corner = np.round(np.array(grid.origin_xy) / CELL_M).astype(np.int64)
        parts = [
            (at, grid_)
            for at, grid_ in ((corner, scan[..., None]), (first_cell, slabs))
            if (grid_ != UNKNOWN).any()
        ]
        if not parts:
            return HeightBands(scan, np.full((1, 1, SLABS), UNKNOWN, np.int8), np.zeros(2))
        low = np.min([at for at, _ in parts], axis=0)
        cols, rows = np.max([at + g.shape[1::-1] for at, g in parts], axis=0) - low
        found = [np.full((rows, cols, n), UNKNOWN, np.int8) for n in (1, SLABS)]
        for at, part in parts:
            col, row = at - low
            whole = found[part.shape[2] != 1]
            whole[row : row + part.shape[0], col : col + part.shape[1]] = part
        return HeightBands(found[0][..., 0], found[1], low * CELL_M)


def _states(log_odds: NDArray[np.floating], seen: NDArray[np.bool_]) -> NDArray[np.int8]:
    states = np.where(log_odds > 0, STANDS, FREE)
    return np.where(seen, states, UNKNOWN).astype(np.int8)
