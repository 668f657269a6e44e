"""Compiled loops over the pixels of parts that may be of one body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.depth_points import points_of_row
from afkb_mapping.kernels import kernel
from afkb_things.cells import step


@kernel
def merged(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    other_u: NDArray[np.int32],
    other_v: NDArray[np.int32],
) -> NDArray[np.int64]:
    """Order by rows, then columns, of pixels and the other pixels behind them."""
    n, m = len(u), len(other_u)
    out, i, j = np.empty(n + m, np.int64), 0, 0
    for k in range(n + m):
        if j == m or (i < n and (v[i] < other_v[j] or (v[i] == other_v[j] and u[i] < other_u[j]))):
            out[k] = i
            i += 1
        else:
            out[k] = n + j
            j += 1
    return out


@kernel
def share_on(
    points: NDArray[np.float64],
    top_m: float,
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
    margin: float,
) -> float:
    """Share of the points (N, 3) below a height that lie on the border of a convex outline."""
    near = total = 0
    for k in range(len(points)):
        if points[k, 2] > top_m:
            continue
        total += 1
        near += inwards(points[k, 0], points[k, 1], normals, offsets) < margin
    return near / total if total else 1.0


@kernel
def inwards(
    x: float, y: float, normals: NDArray[np.float64], offsets: NDArray[np.float64]
) -> float:
    """How far within a convex outline a point lies, m; below 0 outside."""
    least = 1e9
    for k in range(len(offsets)):
        least = min(least, x * normals[k, 0] + y * normals[k, 1] - offsets[k])
    return least


@kernel
def through(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    taken: NDArray[np.bool_],
    box: tuple[int, int, int, int],
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
    margin: float,
    top_m: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Columns and rows of pixels that aren't taken and seen through an outline at a height.

    They and their sight lines, where these pass that height, lie within it by a margin, m.
    """
    u0, v0, u1, v1 = box
    us = np.empty((u1 - u0) * (v1 - v0), np.int32)
    vs = np.empty_like(us)
    cx, cy, ch = T_map_camera[0, 3], T_map_camera[1, 3], T_map_camera[2, 3]
    row, n, drop = np.empty((3, depth_m.shape[1]), np.float32), 0, ch - top_m
    for v in range(v0, v1 if drop > 0 else v0):
        points_of_row(depth_m, v, intrinsics, T_map_camera, row, u0, u1)
        for u in range(u0, u1):
            if taken[v, u] or depth_m[v, u] <= 0:
                continue
            x, y, h = float(row[0, u]), float(row[1, u]), row[2, u]
            if h >= top_m or inwards(x, y, normals, offsets) <= margin:
                continue
            t = drop / (ch - h)
            x, y = cx + (x - cx) * t, cy + (y - cy) * t
            if inwards(x, y, normals, offsets) > margin:
                us[n], vs[n] = u, v
                n += 1
    return us[:n], vs[:n]


@kernel
def pairs_behind(
    depth_m: NDArray[np.float32],
    names: NDArray[np.int32],
    count: int,
    box: tuple[int, int, int, int],
    noise: float,
) -> NDArray[np.int64]:
    """In how many pixel pairs of a box body p lies behind its neighbour q: (count, count)."""
    rows, cols = names.shape
    out = np.zeros((count, count), np.int64)
    u0, v0, u1, v1 = box
    for v in range(v0, v1):
        for u in range(u0, u1):
            p = names[v, u]
            if p == 0:
                continue
            z = depth_m[v, u]
            for dv, du in ((0, 1), (1, 0), (0, -1), (-1, 0)):
                b, a = v + dv, u + du
                reach = 1
                while 0 <= b < rows and 0 <= a < cols and depth_m[b, a] <= 0 and reach < 6:
                    b, a, reach = b + dv, a + du, reach + 1
                if not (0 <= b < rows and 0 <= a < cols):
                    continue
                q = names[b, a]
                if q != 0 and q != p and depth_m[b, a] < z - step(z, noise):
                    out[p - 1, q - 1] += 1
    return out
