"""Free space of an occupancy grid as rooms see it: without furniture, ragged edges and spokes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid

Mask = NDArray[np.bool_]

FREE_BELOW = 0.45
"""Probability below which a cell is free: one beam through it suffices."""
OCCUPIED_ABOVE = 0.55
"""Probability above which a cell is occupied."""
GAP_M = 0.2
"""Unknown gaps up to this width inside free space are spaces between beams or depth pixels."""
SPOKE_M = 1.0
"""Free space narrower than this may be a fan of beams through a window or past a corner,"""
SPOKE_WALLED = 0.3
"""and is, where less than this part of its rim is known to be occupied."""
SEEN_GAP_M = 2.0
"""Space between seen things up to this wide lies in the same room, where no floor was seen."""
FURNITURE_M = 2.4
"""An island in the free space no longer than this is furniture (a bed, a sofa, a cabinet),"""
PARTITION_M = (0.75, 0.35)
"""unless it is at least this long and at most this thick: a piece of wall."""

JAMB_REACH_M = 0.15
"""What stands this near to where a doorway ends is what it hangs in."""


def free_space(grid: OccupancyGrid, jambs_xy: Iterable[NDArray[np.float64]] = ()) -> Mask:
    """(rows, cols) cells of rooms: free ones, and those under furniture that stands free.

    `jambs_xy`: (2, 2) m, map frame, of each doorway that views have shown; what it hangs in is a
    wall, however short.
    """
    resolution = grid.resolution_m
    with np.errstate(invalid="ignore"):
        free = grid.probability < FREE_BELOW
        occupied = grid.probability > OCCUPIED_ABOVE
    free = _closed(free, GAP_M, resolution) & ~occupied
    free = without_furniture(free, resolution, _around(jambs_xy, grid))
    return _without_spokes(free, occupied, resolution)


def seen_space(grid: OccupancyGrid) -> Mask:
    """(rows, cols) the largest patch of what was seen at all, things and the space between them.

    For recordings that look at things and hardly at the floor: they still were in some room.
    """
    seen = _closed(np.isfinite(grid.probability), SEEN_GAP_M, grid.resolution_m)
    patches, _ = ndimage.label(ndimage.binary_fill_holes(seen))
    sizes = np.bincount(patches.ravel())
    sizes[0] = 0
    largest: Mask = (patches == np.argmax(sizes)) & (patches > 0)
    return largest


def without_furniture(free: Mask, resolution: float, walls: Mask | None = None) -> Mask:
    """Free space with small islands filled; kept are pieces of wall, and what touches `walls`."""
    outside = np.pad(~free, 1, constant_values=True)
    islands, _ = ndimage.label(outside, structure=np.ones((3, 3)))
    islands[islands == islands[0, 0]] = 0
    islands = islands[1:-1, 1:-1]
    filled = free.copy()
    for label, window in enumerate(ndimage.find_objects(islands), start=1):
        if window is None:
            continue
        island = islands[window] == label
        if walls is not None and (island & walls[window]).any():
            continue
        if _is_furniture(island, resolution):
            filled[window] |= island
    return filled


def _around(jambs_xy: Iterable[NDArray[np.float64]], grid: OccupancyGrid) -> Mask:
    """(rows, cols) cells as near to a jamb as what it hangs in."""
    near = np.zeros(grid.probability.shape, dtype=bool)
    size_rc = np.array(grid.probability.shape)
    for jambs in jambs_xy:
        cells = np.floor((jambs - grid.origin_xy) / grid.resolution_m).astype(int)[:, ::-1]
        inside = ((cells >= 0) & (cells < size_rc)).all(axis=1)
        near[tuple(cells[inside].T)] = True
    if not near.any():
        return near
    around: Mask = _distance(~near, grid.resolution_m) <= JAMB_REACH_M
    return around


def _is_furniture(island: Mask, resolution: float) -> bool:
    """Whether an island is short, and not as thin as a wall, straight or bent."""
    length = float(np.hypot(*island.shape)) * resolution
    thickness = 2 * float(_distance(np.pad(island, 1), resolution).max())
    is_wall = length >= PARTITION_M[0] and thickness <= PARTITION_M[1]
    return length <= FURNITURE_M and not is_wall


def _without_spokes(free: Mask, occupied: Mask, resolution: float) -> Mask:
    """Free space without narrow parts whose rim is mostly unknown."""
    parts, _ = ndimage.label(free & ~_opened(free, SPOKE_M, resolution))
    kept = free.copy()
    for label, window in enumerate(ndimage.find_objects(parts), start=1):
        around = tuple(slice(max(s.start - 1, 0), s.stop + 1) for s in window)
        part = parts[around] == label
        rim = ndimage.binary_dilation(part) & ~free[around]
        if (rim & occupied[around]).sum() < SPOKE_WALLED * rim.sum():
            kept[around] &= ~part
    return kept


def _closed(mask: Mask, width_m: float, resolution: float) -> Mask:
    """Gaps up to this width filled."""
    radius = width_m / 2
    padded = np.pad(mask, int(np.ceil(radius / resolution)) + 1)
    grown = _distance(~padded, resolution) <= radius
    closed = _distance(grown, resolution) > radius
    cut = int(np.ceil(radius / resolution)) + 1
    return closed[cut:-cut, cut:-cut] | mask


def _opened(mask: Mask, width_m: float, resolution: float) -> Mask:
    """Parts narrower than this removed."""
    padded = np.pad(mask, 1)
    core = _distance(padded, resolution) > width_m / 2
    return (_distance(~core, resolution) <= width_m / 2)[1:-1, 1:-1] & mask


def _distance(mask: Mask, resolution: float) -> NDArray[np.float64]:
    """Distance of each cell of the mask to the nearest cell outside it, m."""
    distance: NDArray[np.float64] = ndimage.distance_transform_edt(mask) * resolution
    return distance
