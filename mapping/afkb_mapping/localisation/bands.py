"""What stands where, by height: what a view is held against when a robot asks where it is.

A laser sees one height, a depth camera all; a chair that is moved hides nothing of what is as tall
as a wall. So there is one grid for what the laser meets, one for whatever stands on the floor, and
one for what reaches above a person's chest.
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
from afkb_mapping.occupancy import RESOLUTION_M, GridBuilder
from afkb_mapping.panorama import panorama_of

SCAN, ANY, TALL = 0, 1, 2
BANDS = 3
STATE_FILE = "bands.npz"
"""In the map's `state/`: `occupancy` (BANDS, rows, cols) int8, percent, -1 unknown; `origin_xy`."""
TRUSTED_M = 5.0
"""Further away depth is wrong by more than two cells."""
UNKNOWN = -1


@dataclass(frozen=True, slots=True, eq=False)
class HeightBands:
    """Occupancy by height: (BANDS, rows, cols) int8, percent, `UNKNOWN` where nothing was seen.

    Cells are `RESOLUTION_M` wide; cell (0, 0) has its lower left corner at `origin_xy`, m, map
    frame; rows run along +y.
    """

    occupancy: NDArray[np.int8]
    origin_xy: NDArray[np.float64]

    def stands(self, band: int) -> NDArray[np.bool_]:
        """(rows, cols): cells in which more likely than not something stands."""
        stands: NDArray[np.bool_] = self.occupancy[band] > 50
        return stands

    def to_bytes(self) -> bytes:
        """The content of `STATE_FILE`; the same for the same bands."""
        file = io.BytesIO()
        np.savez_compressed(file, occupancy=self.occupancy, origin_xy=self.origin_xy)
        return file.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes) -> HeightBands:
        """Raises `MapError` where the content is not what `to_bytes` gives."""
        try:
            with np.load(io.BytesIO(content), allow_pickle=False) as stored:
                occupancy, origin_xy = stored["occupancy"], stored["origin_xy"]
        except (ValueError, OSError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise MapError(f"state/{STATE_FILE}: not readable ({error}); map again") from error
        if occupancy.ndim != 3 or len(occupancy) != BANDS or origin_xy.shape != (2,):
            raise MapError(f"state/{STATE_FILE}: not the height bands of a map; map again")
        return cls(occupancy.astype(np.int8), origin_xy.astype(np.float64))


class BandBuilder:
    """Builds the bands view by view; they grow with the area that is seen, not with time."""

    def __init__(self) -> None:
        self._grids = [GridBuilder() for _ in range(BANDS)]

    def add(self, view: View) -> None:
        """Take in a view that is placed in the map frame."""
        if view.scan is not None:
            T = view.T_map_laser
            ends = transform_xy(T, view.scan.points_xy)
            self._grids[SCAN].insert_beams(T[:2, 3], ends, np.ones(len(ends), np.bool_))
        panorama = panorama_of(view)
        if panorama is None:
            return
        for band, ranges in ((ANY, panorama.obstacle_m), (TALL, panorama.tall_m)):
            hit = ranges < TRUSTED_M
            reach = np.where(hit, ranges, panorama.free_m if band == ANY else 0.0)
            seen = (reach > 0) & (reach < TRUSTED_M)
            self._grids[band].insert_beams(
                panorama.center_xy, panorama.ends_xy(reach)[seen], hit[seen]
            )

    def bands(self) -> HeightBands:
        """What was seen so far."""
        grids = [builder.grid() for builder in self._grids]
        known = [g for g in grids if np.isfinite(g.probability).any()]
        if not known:
            return HeightBands(np.full((BANDS, 1, 1), UNKNOWN, np.int8), np.zeros(2))
        low = np.min([g.origin_xy for g in known], axis=0)
        corners = [
            np.round((np.array(g.origin_xy) - low) / RESOLUTION_M).astype(int) for g in known
        ]
        size = np.max(
            [c + g.probability.shape[::-1] for c, g in zip(corners, known, strict=True)], axis=0
        )
        found = np.full((BANDS, size[1], size[0]), UNKNOWN, np.int8)
        for band, grid in enumerate(grids):
            if not np.isfinite(grid.probability).any():
                continue
            col, row = np.round((np.array(grid.origin_xy) - low) / RESOLUTION_M).astype(int)
            rows, cols = grid.probability.shape
            percent = np.nan_to_num(np.round(grid.probability * 100), nan=UNKNOWN)
            found[band, row : row + rows, col : col + cols] = percent
        return HeightBands(found, low)
