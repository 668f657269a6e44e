"""Points of things as their own visit measured them, and how another visit's views look at them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.depth_points import intrinsics_of, points_of_pixels
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.things.visibility import (
    MARGIN_M,
    MARGIN_PER_RANGE,
    NEAREST_M,
    NOT_LOOKED_AT,
    USABLE_RANGE_M,
    Look,
)
from afkb_mapping.visits.things import ComparedThing

Array = NDArray[np.float64]

MOST_POINTS = 200
"""So many points are kept of a thing; a mug at 2 m is some ten of a remembered view."""
LEAST_POINTS = 12
"""Fewer say little of a thing's shape: it is then looked at as a body without form."""
ABOVE_FOOT_M = 0.02
"""What is no higher than this above a thing's foot may be what it stands on: noise of depth."""
MIDDLE = 4
"""Of a pixel and those next to it, row by row."""
TELLING = 1.5
"""A ray tells whether a point has gone if what is behind it is so many margins away."""


def body_points(
    things: Sequence[ComparedThing], views: Iterable[RememberedView], T_things_views: Array
) -> list[Array]:
    """(N, 3) points of each thing's body, m, in the things' frame; none for flat tops.

    `views`: of the visit that saw the things; `T_things_views` (4, 4): from their map's frame.
    """
    found: list[list[Array]] = [[] for _ in things]
    bodies = [(i, t) for i, t in enumerate(things) if not t.is_surface]
    for view in placed(views, T_things_views) if bodies else ():
        shown = [(i, t) for i, t in bodies if may_show(view, t)]
        points = _points(view) if shown else np.zeros((0, 3))
        for i, thing in shown:
            found[i].append(points[is_within(thing, points, ABOVE_FOOT_M)])
    return [_some(np.concatenate([np.zeros((0, 3)), *parts])) for parts in found]


def placed(views: Iterable[RememberedView], T: Array) -> Iterator[View]:
    """The views alone, moved by T (4, 4) to another map's frame."""
    return (replace(r.view, T_map_base=T @ r.T_map_base) for r in views)


def may_show(view: View, thing: ComparedThing) -> bool:
    """Whether a ball around a thing reaches into what a view's depth camera has in view."""
    if view.depth_m is None:
        return False
    fx, fy, cx, cy = intrinsics_of(view)
    T, radius = view.T_map_camera, math.hypot(*thing.size_xyz) / 2
    x, y, z = T[:3, :3].T @ (np.array(thing.xyz) - T[:3, 3])
    rows, cols = view.depth_m.shape
    # How far a ball reaches beyond an edge of the image is its radius times the slant of that edge.
    aside = max(cx, cols - cx) / fx, max(cy, rows - cy) / fy
    return bool(
        -radius < z < USABLE_RANGE_M + radius
        and abs(x) <= aside[0] * z + radius * math.hypot(1.0, aside[0])
        and abs(y) <= aside[1] * z + radius * math.hypot(1.0, aside[1])
    )


def _points(view: View) -> Array:
    """(N, 3) all that a view's depth shows within its usable range, m, map frame."""
    if view.depth_m is None:
        return np.zeros((0, 3))
    v, u = np.nonzero((view.depth_m > NEAREST_M) & (view.depth_m < USABLE_RANGE_M))
    return points_of_pixels(u.astype(np.int32), v.astype(np.int32), view)[1]


def is_within(thing: ComparedThing, points: Array, above_m: float = 0.0) -> NDArray[np.bool_]:
    """(N,) whether points (N, 3) lie in a thing's box, so far at least above its foot."""
    of = (points[:, 2] >= thing.bottom_m + above_m) & (points[:, 2] <= thing.top_m)
    reach = np.array(thing.size_xyz[:2]) / 2
    near = np.flatnonzero(of & (np.abs(points[:, :2] - thing.xyz[:2]).max(axis=1) <= sum(reach)))
    c, s = math.cos(thing.yaw), math.sin(thing.yaw)
    along = (points[near, :2] - thing.xyz[:2]) @ np.array([[c, -s], [s, c]])
    of[:] = False
    of[near] = (np.abs(along) <= reach).all(axis=1)
    return of


def _some(points: Array) -> Array:
    """At most `MOST_POINTS` of them, evenly; none where they are too few."""
    if len(points) < LEAST_POINTS:
        return np.zeros((0, 3))
    return points[:: -(-len(points) // MOST_POINTS)]


def look_at_body(view: View, points: Array, bottom_m: float) -> Look:
    """How a view looked at points (N, 3) of a thing that stands `bottom_m` above the floor.

    Only rays count that tell: on which, had the thing gone, what it stands on would be seen clearly
    behind it. A point is *empty* where depth lies clearly behind it, and beside it too, *hit*
    where depth agrees; what is in front hides it. `in_view`: share of the points that are either.
    """
    if view.depth_m is None:
        return NOT_LOOKED_AT
    fx, fy, cx, cy = intrinsics_of(view)
    T = np.linalg.inv(view.T_map_camera)
    x, y, z = T[:3, :3] @ points.T + T[:3, 3:]
    safe = np.where(z > NEAREST_M, z, np.inf)
    u, v = np.rint(fx * x / safe + cx).astype(int), np.rint(fy * y / safe + cy).astype(int)
    rows, cols = view.depth_m.shape
    asked = (z > NEAREST_M) & (z < USABLE_RANGE_M)
    asked &= (u >= 0) & (u < cols) & (v >= 0) & (v < rows)
    margin = MARGIN_M + MARGIN_PER_RANGE * z
    asked &= _behind_if_gone(view, points, bottom_m, z) >= TELLING * margin
    measured = _around(view.depth_m, u[asked], v[asked])
    behind = np.where(measured > 0, measured - z[asked], np.nan)
    hit = (np.abs(behind) <= margin[asked]).any(axis=0)
    through = (behind > margin[asked]) | np.isnan(behind)
    empty = through.all(axis=0) & (measured[MIDDLE] > 0)
    told = int(hit.sum() + empty.sum())
    if not told:
        return NOT_LOOKED_AT
    return Look(told / len(points), int(empty.sum()) / told, int(hit.sum()) / told)


def _around(
    depth_m: NDArray[np.float32], u: NDArray[np.int64], v: NDArray[np.int64]
) -> NDArray[np.float32]:
    """(9, N) depth of pixels and of those next to them: poses are off by about one."""
    rows, cols = depth_m.shape
    steps = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return np.array(
        [depth_m[np.clip(v + i, 0, rows - 1), np.clip(u + j, 0, cols - 1)] for i, j in steps]
    )


def _behind_if_gone(view: View, points: Array, bottom_m: float, depths: Array) -> Array:
    """(N,) how much more depth, m, the ray to each point would have down to `bottom_m`."""
    falls = view.T_map_camera[2, 3] - points[:, 2]
    return np.where(falls > 0, depths * (points[:, 2] - bottom_m) / np.maximum(falls, 1e-6), np.inf)
