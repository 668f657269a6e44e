"""Which room a point belongs to, things against the wall and under the furniture included."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.rooms import Segmentation

REACH_M = 1.5
"""A thing belongs to the nearest room within half a deep piece of furniture plus a wall."""


class RoomLookup:
    """Rooms by position; `room_at` names them `room-1`, `room-2` …, largest first."""

    def __init__(self, segmentation: Segmentation, grid: OccupancyGrid) -> None:
        self._resolution_m, self._origin_xy = grid.resolution_m, np.asarray(grid.origin_xy)
        self._nearest = segmentation.labels
        if segmentation.rooms:
            distance, cells = ndimage.distance_transform_edt(
                segmentation.labels == 0, return_indices=True
            )
            nearest = segmentation.labels[tuple(cells)]
            self._nearest = np.where(distance * grid.resolution_m <= REACH_M, nearest, 0)

    def room_at(self, x: float, y: float) -> str | None:
        """Id of the room at a point of the map frame (m), or None far from every room."""
        col, row = np.floor((np.array([x, y]) - self._origin_xy) / self._resolution_m).astype(int)
        rows, cols = self._nearest.shape
        if not (0 <= row < rows and 0 <= col < cols) or not self._nearest[row, col]:
            return None
        return room_id(int(self._nearest[row, col]))


def room_id(label: int) -> str:
    """Id of the room with this label in a segmentation."""
    return f"room-{label}"
