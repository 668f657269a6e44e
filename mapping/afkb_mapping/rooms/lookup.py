"""Which room a point belongs to, things against the wall and under the furniture included."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.rooms.rooms import Segmentation

REACH_M = 1.5
"""A thing belongs to the nearest room within half a deep piece of furniture plus a wall."""


class RoomLookup:
    """Rooms by position, named `room-1`, `room-2` …, largest first."""

    def __init__(self, segmentation: Segmentation, grid: OccupancyGrid) -> None:
        self._resolution_m, self._origin_xy = grid.resolution_m, np.asarray(grid.origin_xy)
        self._nearest = segmentation.labels
        self._distance_m = np.zeros(segmentation.labels.shape)
        if segmentation.rooms:
            distance, cells = ndimage.distance_transform_edt(
                segmentation.labels == 0, return_indices=True
            )
            self._nearest = segmentation.labels[tuple(cells)]
            self._distance_m = distance * grid.resolution_m

    def room_at(self, x: float, y: float) -> str | None:
        """Id of the room at a point of the map frame (m), or None far from every room."""
        row, col = self._cell(x, y)
        rows, cols = self._nearest.shape
        if not (0 <= row < rows and 0 <= col < cols) or self._distance_m[row, col] > REACH_M:
            return None
        label = int(self._nearest[row, col])
        return room_id(label) if label else None

    def nearest_room(self, x: float, y: float) -> str | None:
        """Id of the room nearest to where the robot stood, even at the edge of what it saw."""
        rows, cols = self._nearest.shape
        row, col = self._cell(x, y)
        label = int(self._nearest[min(max(row, 0), rows - 1), min(max(col, 0), cols - 1)])
        return room_id(label) if label else None

    def _cell(self, x: float, y: float) -> tuple[int, int]:
        col, row = np.floor((np.array([x, y]) - self._origin_xy) / self._resolution_m).astype(int)
        return int(row), int(col)


def room_id(label: int) -> str:
    """Id of the room with this label in a segmentation."""
    return f"room-{label}"
