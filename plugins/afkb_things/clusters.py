"""Things on one support, told apart from above."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body, Stand
from afkb_mapping.depth_points import points_at
from afkb_mapping.from_above import hull_candidates
from afkb_mapping.grid.components import AREA, components
from afkb_mapping.image_regions import order_by_label, pixels_by_label
from afkb_mapping.kernels import kernel
from afkb_things.scene import Scene
from afkb_things.settings import ThingSettings

MAX_GRID_CELLS = 4_000_000
Box = tuple[int, int, int, int]


def clusters_from_above(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    scene: Scene,
    support: int,
    settings: ThingSettings,
) -> Iterator[Body]:
    """Split pixels where, seen from above, nothing tall lies between them.

    A mug's far inner wall is separated from its front by a step in depth, but not from above:
    its rim joins them. Only what rises by core_m joins, so that a magazine under a mug doesn't
    make one thing of them; lower points go to the thing within whose hull they lie. Heights are
    those over the support, so that a tilt of the view doesn't reach them.
    """
    least_tall = settings.min_pixels // 2
    height_m, slope = float(scene.supports.heights_m[support]), scene.slope_under(support)
    depths, xyz, tall, ij, count, (i0, j0, i1, j1) = _over_support(
        u, v, scene.depth_m, scene.intrinsics, scene.T_map_camera, scene.overs_m, height_m,
        settings.core_m, settings.cell_m,
    )  # fmt: skip
    if count < least_tall or (i1 - i0 + 5) * (j1 - j0 + 5) > MAX_GRID_CELLS:
        return
    ij -= np.array([i0 - 2, j0 - 2])
    names, enough = _names_from_above(ij, tall, (i1 - i0 + 5, j1 - j0 + 5), least_tall)
    order, starts = order_by_label(_name_each(ij, names), enough)
    stand = (scene.depth_m.shape, Stand.ON_SUPPORT, height_m, slope)
    whole = Body(u, v, depths, xyz, *stand, noise=scene.noise)
    for k in np.flatnonzero(np.diff(starts) >= settings.min_pixels):
        yield whole.part(order[starts[k] : starts[k + 1]])


@kernel
def _over_support(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    overs_m: NDArray[np.float32],
    support_height_m: float,
    core_m: float,
    cell_m: float,
) -> tuple[
    NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.int64], int, Box
]:
    """Depths and points of pixels, which are tall, their grid squares; number and box of those."""
    n = len(u)
    depths, xyz = points_at(u, v, depth_m, intrinsics, T_map_camera)
    tall, ij = np.empty(n, np.bool_), np.empty((n, 2), np.int64)
    far = np.int64(1 << 60)
    i0, j0, i1, j1, count = far, far, -far, -far, 0
    for m in range(n):
        over = overs_m[v[m], u[m]]
        tall[m] = over > core_m
        xyz[m, 2] = np.float32(support_height_m) + over
        i, j = np.int64(np.floor(xyz[m, 0] / cell_m)), np.int64(np.floor(xyz[m, 1] / cell_m))
        ij[m, 0], ij[m, 1] = i, j
        if tall[m]:
            i0, j0, i1, j1, count = min(i0, i), min(j0, j), max(i1, i), max(j1, j), count + 1
    return depths, xyz, tall, ij, count, (i0, j0, i1, j1)


@kernel
def _grid_of(
    ij: NDArray[np.int64], tall: NDArray[np.bool_], shape: tuple[int, int]
) -> NDArray[np.uint8]:
    """Squares (X, Y) that hold tall points, each marked together with the next ones."""
    grid = np.zeros(shape, np.uint8)
    for n in range(len(ij)):
        if tall[n]:
            i, j = ij[n, 0], ij[n, 1]
            grid[i, j] = grid[i, j + 1] = grid[i + 1, j] = grid[i + 1, j + 1] = 1
    return grid


@kernel
def _name_each(ij: NDArray[np.int64], names: NDArray[np.int32]) -> NDArray[np.int32]:
    """Name of the grid square of each point (N,); 0 for one that lies off the grid."""
    of = np.zeros(len(ij), np.int32)
    for n in range(len(ij)):
        i, j = ij[n, 0], ij[n, 1]
        if 0 <= i < names.shape[0] and 0 <= j < names.shape[1]:
            of[n] = names[i, j]
    return of


@kernel
def _tall_in_each(
    ij: NDArray[np.int64], tall: NDArray[np.bool_], parts: NDArray[np.int32], count: int
) -> NDArray[np.int64]:
    """Number of tall points in each part of a grid."""
    numbers = np.zeros(count, np.int64)
    for n in range(len(ij)):
        if tall[n]:
            numbers[parts[ij[n, 0], ij[n, 1]]] += 1
    return numbers


def _names_from_above(
    ij: NDArray[np.int64], tall: NDArray[np.bool_], shape: tuple[int, int], least_tall: int
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
    """Connected groups of grid squares, from 1, each filled to its convex hull: (X, Y).

    And which groups hold enough tall points. A larger group's hull goes before a smaller one's,
    a group's own squares before any hull.
    """
    parts, measures = components(_grid_of(ij, tall, shape), True)
    count = len(measures)
    enough = _tall_in_each(ij, tall, parts, count) >= least_tall
    enough[0] = False
    by_area = sorted(range(1, count), key=lambda k: -int(measures[k, AREA]))
    while by_area and not enough[by_area[-1]]:
        by_area.pop()
    wanted = np.zeros(count, np.bool_)
    wanted[by_area] = True
    columns, rows, starts = pixels_by_label(parts, wanted, np.ones(count, np.int64))
    names = np.zeros(shape, np.int32)
    for k in by_area:
        own = slice(int(starts[k]), int(starts[k + 1]))
        _fill_hull(names, columns[own], rows[own], k, measures[k])
    np.copyto(names, parts, where=parts > 0)
    return names, enough


def _fill_hull(
    names: NDArray[np.int32],
    columns: NDArray[np.int32],
    rows: NDArray[np.int32],
    k: int,
    measures: NDArray[np.int32],
) -> None:
    """Give the squares within a group's hull that have no name yet the name k."""
    x, y, w, h = (int(n) for n in measures[:4])
    corners = hull_candidates(np.column_stack([columns - x, rows - y])).astype(np.int32)
    filled = np.zeros((h, w), np.uint8)
    cv2.fillConvexPoly(filled, cv2.convexHull(corners), 1)
    part = names[y : y + h, x : x + w]
    part[(filled > 0) & (part == 0)] = k
