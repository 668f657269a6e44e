"""What an occupancy grid says of a passage: how far the way round it is, and whether it is narrow.

A gap between a cabinet and the wall behind it is as wide as a door. But one walks round the
cabinet in a few steps, and out of a room by its doors only.
"""

from __future__ import annotations

import heapq
import math

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.grid.free_space import FREE_BELOW
from afkb_mapping.kernels import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

DETOUR_M = (2.5, 4.0)
"""Way round a passage: furniture needs less than the first, a wall with a door more than the
second."""
BESIDE_M = 0.4
"""Where the way round begins and ends: this far from the line between the jambs."""
REACH_M = 0.8
"""What leads on from a gap begins within this of its middle, chairs beside it or not."""
POCKET_M2 = 0.3
"""A dead end with less room than this to stand in, clear of its walls, is a niche."""
CLEARANCE_M = 0.15
"""A way goes where this much is free to either side: nobody walks through a narrower slit."""
WINDOW_M = 5.0
"""Nothing further away is looked at."""
WIDER = 1.3
"""A door is narrower than what it leads from or to: there the way is this much as wide."""
SHIFTS_M = (0.4, 0.6, 0.8)
LEFT_OVER = 0.3
"""What a gap keeps of its probability in a corridor no wider before it and behind."""


def way_free(grid: OccupancyGrid, blocked: Mask) -> Mask:
    """(rows, cols) free cells, without those where depth saw what a laser looks under."""
    with np.errstate(invalid="ignore"):
        free: Mask = (grid.probability < FREE_BELOW) & ~blocked
    return free


def room_to_room(jambs_xy: Array, free_cells: Mask, grid: OccupancyGrid) -> float:
    """How well a gap between jambs (2, 2), m, parts two areas of free cells, 0 to 1."""
    free, origin = _window(jambs_xy, free_cells, grid)
    resolution = grid.resolution_m
    jambs = (jambs_xy - origin) / resolution
    round_ = _way_round(free, jambs, _normal(jambs) * BESIDE_M / resolution, resolution)
    short, long = DETOUR_M
    parted = min(1.0, max(0.0, (round_ - short) / (long - short)))
    return parted * (1.0 if is_narrow(jambs_xy, free_cells, grid) else LEFT_OVER)


def is_narrow(jambs_xy: Array, free_cells: Mask, grid: OccupancyGrid) -> bool:
    """Whether a gap between jambs (2, 2), m, is narrower than the way before it or behind it."""
    free, origin = _window(jambs_xy, free_cells, grid)
    jambs = (jambs_xy - origin) / grid.resolution_m
    width, normal = math.dist(*jambs.tolist()), _normal(jambs) / grid.resolution_m
    return any(
        _width_at(free, jambs, sign * shift * normal) >= WIDER * width
        for sign in (-1, 1)
        for shift in SHIFTS_M
    )


def _normal(jambs: Array) -> Array:
    """(2,) unit, straight through a gap."""
    along = jambs[1] - jambs[0]
    return np.array([-along[1], along[0]]) / math.hypot(*along)


def _window(jambs_xy: Array, free_cells: Mask, grid: OccupancyGrid) -> tuple[Mask, Array]:
    """Free cells around a gap, and where (m) the corner of the first one is."""
    origin, resolution = np.array(grid.origin_xy), grid.resolution_m
    low = np.floor((jambs_xy.min(axis=0) - WINDOW_M - origin) / resolution).astype(int)
    high = np.ceil((jambs_xy.max(axis=0) + WINDOW_M - origin) / resolution).astype(int)
    low = np.maximum(low, 0)
    free = free_cells[low[1] : max(high[1], 0), low[0] : max(high[0], 0)]
    return np.pad(free, 1), origin + (low - 1) * resolution


def _way_round(free: Mask, jambs: Array, beside: Array, resolution: float) -> float:
    """Length of the shortest free way from one side of a gap to the other but through it, m.

    0 where a side is not free or but a niche; inf where there is none in the window.
    """
    import cv2

    wall = np.zeros(free.shape, dtype=np.uint8)
    step = (jambs[1] - jambs[0]) / np.linalg.norm(jambs[1] - jambs[0]) * 2
    ends = np.round(np.array([jambs[0] - step, jambs[1] + step]) - 0.5).astype(int)
    cv2.line(wall, ends[0].tolist(), ends[1].tolist(), 1, lineType=cv2.LINE_4, thickness=2)
    roomy = ndimage.distance_transform_edt(free) * resolution > CLEARANCE_M
    open_ = roomy & (wall == 0)
    parts, _ = ndimage.label(open_)
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    middle = jambs.mean(axis=0)
    sides = (_beside(parts, sizes, middle, sign * beside, resolution) for sign in (1, -1))
    start, goal = sides
    least = POCKET_M2 / resolution**2
    if any(cell is None or sizes[parts[cell]] < least for cell in (start, goal)):
        return 0.0
    assert start is not None and goal is not None
    if parts[start] != parts[goal]:
        return math.inf
    return _distance(open_, start, goal) * resolution


def _beside(
    parts: NDArray[np.int32],
    sizes: NDArray[np.intp],
    middle: Array,
    beside: Array,
    resolution: float,
) -> tuple[int, int] | None:
    """A cell (row, column) of the largest part that begins on one side of a gap, near it."""
    reach = round(REACH_M / resolution)
    col, row = (int(k) for k in middle)
    r0, c0 = max(row - reach, 0), max(col - reach, 0)
    cells = np.argwhere(parts[r0 : row + reach + 1, c0 : col + reach + 1]) + np.array([r0, c0])
    off = cells[:, ::-1] + 0.5 - middle
    cells = cells[(off @ beside > 0) & (np.hypot(off[:, 0], off[:, 1]) <= reach)]
    if not len(cells):
        return None
    part = parts[cells[:, 0], cells[:, 1]]
    cells = cells[sizes[part] == sizes[part].max()]
    nearest = cells[np.argmin(((cells[:, ::-1] + 0.5 - middle - beside) ** 2).sum(axis=1))]
    return int(nearest[0]), int(nearest[1])


@kernel
def _distance(open_: Mask, start: tuple[int, int], goal: tuple[int, int]) -> float:
    """Shortest way between two open cells over their eight neighbours, in cells (Dijkstra)."""
    rows, cols = open_.shape
    least = np.full((rows, cols), np.inf)
    least[start] = 0.0
    ahead = [(0.0, start[0], start[1])]
    while ahead:
        so_far, row, col = heapq.heappop(ahead)
        if row == goal[0] and col == goal[1]:
            return so_far
        if so_far > least[row, col]:
            continue
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                r, c = row + dr, col + dc
                if 0 <= r < rows and 0 <= c < cols and open_[r, c]:
                    there = so_far + math.sqrt(dr * dr + dc * dc)
                    if there < least[r, c]:
                        least[r, c] = there
                        heapq.heappush(ahead, (there, r, c))
    return math.inf


def _width_at(free: Mask, jambs: Array, shift: Array) -> float:
    """Free cells in line with a gap that is shifted to before or behind it."""
    middle = jambs.mean(axis=0) + shift
    step = (jambs[1] - jambs[0]) / np.linalg.norm(jambs[1] - jambs[0])
    return sum(_run(free, middle, sign * step) for sign in (1, -1))


def _run(free: Mask, start: Array, step: Array) -> float:
    longest = int(WINDOW_M / 0.05)
    cells = np.floor(start + np.outer(np.arange(longest), step)).astype(int)
    inside = ((cells >= 0) & (cells < np.array(free.shape[::-1]))).all(axis=1)
    cells = cells[inside]
    blocked = np.flatnonzero(~free[cells[:, 1], cells[:, 0]])
    return float(blocked[0]) if len(blocked) else float(len(cells))
