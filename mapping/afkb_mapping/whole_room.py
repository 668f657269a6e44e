"""One room for what was seen, where too little floor was seen to tell rooms apart.

A hand-held camera over a table sees hardly any floor; everything it sees is in one room all the
same, until walls say otherwise.
"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.rooms import RoomShape, Segmentation, segment_rooms

GAP_M = 0.5
"""What lies closer together than a person's width is seen in one room."""


def rooms_or_whole(grid: OccupancyGrid) -> Segmentation:
    """The segmentation of the grid; where it has no room, all that is known of it as one."""
    found = segment_rooms(grid)
    return found if found.rooms else _whole(grid)


def _whole(grid: OccupancyGrid) -> Segmentation:
    import cv2

    known = np.isfinite(grid.probability)
    reach = round(GAP_M / grid.resolution_m)
    padded = np.pad(known, reach).astype(np.uint8)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (reach + 1, reach + 1))
    closed = cv2.morphologyEx(padded, cv2.MORPH_CLOSE, disc)[reach:-reach, reach:-reach]
    parts, count = ndimage.label(closed)
    if not count:
        return Segmentation(np.zeros(known.shape, np.int32), (), ())
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    mask = (parts == int(np.argmax(sizes))).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    outline = cv2.approxPolyDP(max(contours, key=cv2.contourArea), 1.0, True).reshape(-1, 2)
    origin = np.asarray(grid.origin_xy)
    polygon = (outline.astype(np.float64) + 0.5) * grid.resolution_m + origin
    depth = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    row, col = np.unravel_index(int(np.argmax(depth)), mask.shape)
    x, y = (np.array([col, row]) + 0.5) * grid.resolution_m + origin
    area = float(mask.sum()) * grid.resolution_m**2
    shape = RoomShape(1, area, polygon, (float(x), float(y)))
    return Segmentation(mask.astype(np.int32), (shape,), ())
