"""Things on one support, told apart from above."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from afkb_containers.stand import Stand
from afkb_mapping.sensor_noise import depth_sigma

MAX_GRID_CELLS = 4_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Cluster:
    """Pixels of one thing: coordinates, depth (m) and points in the map frame, all (N, …).

    `support_height_m` is None where what it stands on isn't seen.
    """

    stand: Stand

    u: NDArray[np.int64]
    v: NDArray[np.int64]
    depth_m: NDArray[np.float32]
    points: NDArray[np.float64]
    shape: tuple[int, ...]
    support_height_m: float | None

    @property
    def lowest_m(self) -> float:
        """Height of the lowest part in sight, strays left out, m."""
        return float(np.percentile(self.points[:, 2], 2))

    @property
    def sigma_m(self) -> float:
        """Standard deviation of its depth, m."""
        return float(depth_sigma(float(np.median(self.depth_m))))

    @property
    def image_box(self) -> tuple[int, int, int, int]:
        """Half-open (u0, v0, u1, v1)."""
        return int(self.u.min()), int(self.v.min()), int(self.u.max()) + 1, int(self.v.max()) + 1

    @property
    def cut_by_image(self) -> bool:
        """Whether it reaches the image edge."""
        u0, v0, u1, v1 = self.image_box
        return u0 <= 1 or v0 <= 1 or u1 >= self.shape[1] - 1 or v1 >= self.shape[0] - 1


def clusters_from_above(
    flat: NDArray[np.int64],
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    overs_m: NDArray[np.float32],
    support_height_m: float,
    core_m: float,
    cell_m: float,
    min_pixels: int,
) -> Iterator[Cluster]:
    """Split pixels (flat indexes) where, seen from above, nothing tall lies between them.

    A mug's far inner wall is separated from its front by a step in depth, but not from above:
    its rim joins them. Only what rises by core_m joins, so that a magazine under a mug doesn't
    make one thing of them; lower points go to the thing within whose hull they lie. Heights are
    those over the support (overs_m), so that a tilt of the view doesn't reach them.
    """
    xyz = points.reshape(-1, 3)[flat].astype(np.float64)
    over = overs_m.ravel()[flat]
    tall = over > core_m
    xyz[:, 2] = support_height_m + over
    if tall.sum() < min_pixels // 2:
        return
    ij = np.floor(xyz[:, :2] / cell_m).astype(np.int64)
    low = ij[tall].min(axis=0) - 2
    span = ij[tall].max(axis=0) - low + 3
    if span[0] * span[1] > MAX_GRID_CELLS:
        return
    ij -= low
    names = _names_from_above(ij[tall], (int(span[0]), int(span[1])))
    on_grid = ((ij >= 0) & (ij < span)).all(axis=1)
    of = np.zeros(len(flat), np.int32)
    of[on_grid] = names[ij[on_grid, 0], ij[on_grid, 1]]
    order = np.argsort(of, kind="stable")
    starts = np.searchsorted(of[order], np.arange(1, int(names.max()) + 2))
    for begin, end in pairwise(starts):
        member = order[begin:end]
        if len(member) >= min_pixels and tall[member].sum() >= min_pixels // 2:
            v, u = np.divmod(flat[member], depth_m.shape[1])
            yield Cluster(
                Stand.ON_SUPPORT, u, v, depth_m[v, u], xyz[member], depth_m.shape, support_height_m
            )


def _names_from_above(ij: NDArray[np.int64], shape: tuple[int, int]) -> NDArray[np.int32]:
    """Connected groups of grid squares, from 1, each filled to its convex hull: (X, Y)."""
    grid = np.zeros(shape, np.uint8)
    grid[ij[:, 0], ij[:, 1]] = 1
    count, parts, stats, _ = cv2.connectedComponentsWithStats(
        cv2.dilate(grid, np.ones((2, 2), np.uint8)), connectivity=8
    )
    names = np.zeros(shape, np.int32)
    for k in sorted(range(1, count), key=lambda k: -int(stats[k, cv2.CC_STAT_AREA])):
        x, y, w, h = (int(n) for n in stats[k, :4])
        own = np.argwhere(parts[y : y + h, x : x + w] == k)
        filled = np.zeros((h, w), np.uint8)
        cv2.fillConvexPoly(filled, cv2.convexHull(own[:, ::-1].astype(np.int32)), 1)
        part = names[y : y + h, x : x + w]
        part[(filled > 0) & (part == 0)] = k
        part[own[:, 0], own[:, 1]] = k
    return names


@njit(cache=True)
def surroundings(
    u: NDArray[np.int64],
    v: NDArray[np.int64],
    depth_m: NDArray[np.float32],
    mine: NDArray[np.int32],
    name: int,
    labels: NDArray[np.int16],
    overs_m: NDArray[np.float32],
    core_m: float,
) -> tuple[float, float, float, float]:
    """What a thing's outline borders on: shares of attached, behind it, before it, missing.

    Attached: the surface goes on, off the support, so that this is a part of something larger.
    What rises less than core_m over the support (overs_m) is its foot, or a cloth below it.
    `mine` (H, W) holds `name` at the thing's pixels; `labels` (H, W) is negative on supports.
    """
    rows, cols = depth_m.shape
    attached = behind = before = missing = total = 0
    for k in range(len(u)):
        z = depth_m[v[k], u[k]]
        jump = 0.015 + 3.0 * depth_sigma(z)
        for du, dv in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            i, j = v[k] + dv, u[k] + du
            if 0 <= i < rows and 0 <= j < cols and mine[i, j] == name:
                continue
            # speckle: look a little further for the next pixel that returned
            reach = 1
            while 0 <= i < rows and 0 <= j < cols and depth_m[i, j] <= 0 and reach < 4:
                i, j, reach = i + dv, j + du, reach + 1
            if not (0 <= i < rows and 0 <= j < cols):
                total += 1
                missing += 1
                continue
            if mine[i, j] == name:
                continue
            total += 1
            other = depth_m[i, j]
            if other <= 0:
                missing += 1
            elif other > z + jump:
                behind += 1
            elif other < z - jump:
                before += 1
            elif labels[i, j] == 0 or (labels[i, j] > 0 and overs_m[i, j] > core_m):
                attached += 1
            else:
                behind += 1
    total = max(total, 1)
    return attached / total, behind / total, before / total, missing / total
