"""Why there is no way: the narrowest place of the widest one, and what robot would pass it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from afkb_mapping.routes.drivable import Cell, Drivable
from afkb_mapping.routes.ends import End, name_of
from afkb_mapping.routes.grid_paths import GridPaths
from afkb_mapping.routes.standing_points import Standing

NEAR_M = 1.0
"""A narrow place this near to a doorway's middle is that doorway."""
LEAST_RADIUS_M = 0.05
"""A gap that lets only narrower robots through is one of the map, and no way."""
EIGHT = np.ones((3, 3), dtype=int)


@dataclass(frozen=True, slots=True)
class NarrowPlace:
    """Where the widest way is narrowest, m, and the greatest radius, m, that passes there."""

    x: float
    y: float
    radius_m: float


def narrowest(where: Drivable, start: Cell, end: Cell) -> NarrowPlace | None:
    """The narrow place that parts two cells, or None where no robot at all would pass."""
    clearance = where.clearance_m
    limit = min(float(clearance[start]), float(clearance[end]))
    widths = np.unique(clearance[(clearance > 0) & (clearance <= limit)])
    low, high = 0, len(widths)
    while low < high:
        middle = (low + high) // 2
        parts, _ = ndimage.label(clearance >= widths[middle], structure=EIGHT)
        if parts[start] == parts[end]:
            low = middle + 1
        else:
            high = middle
    if low == 0:
        return None
    return _on_the_way(where, start, end, float(widths[low - 1]))


def no_way(standing: Standing, start: Cell, end: End) -> str:
    """Why no way leads from a cell to an end, and which robot could go there."""
    name, where = name_of(end), standing.where
    goal = standing.at_any_width(end)
    narrow = narrowest(where, start, goal) if goal else None
    if narrow is None or narrow.radius_m < LEAST_RADIUS_M:
        return f"no way to {name}: walls, or what nobody has seen, lie between"
    xy = narrow.x, narrow.y
    doors = standing.known.doorways.values()
    near = min(doors, key=lambda d: math.dist(d.xy, xy), default=None)
    at = f" ({near.id})" if near and math.dist(near.xy, xy) < NEAR_M else ""
    widest = math.floor(narrow.radius_m * 100) / 100
    return (
        f"no way to {name} for a robot of radius {where.radius_m:.2f} m: too narrow at "
        f"{xy[0]:.2f},{xy[1]:.2f}{at}; --robot-radius {widest:.2f} would pass"
    )


def _on_the_way(where: Drivable, start: Cell, end: Cell, radius_m: float) -> NarrowPlace | None:
    free = where.clearance_m >= radius_m
    path = GridPaths(replace(where, free=free, radius_m=radius_m)).path(start, end)
    if path is None:
        # It would have to cut a corner between two obstacles.
        return None
    n = max(2, int(np.linalg.norm(np.diff(path, axis=0), axis=1).sum() / where.resolution_m))
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    along = np.linspace(0, lengths[-1], n)
    points = np.column_stack([np.interp(along, lengths, axis) for axis in path.T])
    cells = [where.cell(xy) for xy in points]
    tightest = min(range(n), key=lambda i: where.clearance_m[cells[i] or start])
    x, y = points[tightest]
    return NarrowPlace(float(x), float(y), radius_m)
