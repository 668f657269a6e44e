"""Which pixels show something that stands on which support."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.depth_points import points_of_row
from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_things.supports import RASTER_M, WALL_BIT

CELLS_PER_M = np.float32(1.0 / RASTER_M)
ON_WALL = -2
FLOOR_M = 0.03
MAX_SLOPE = 0.05
MIN_SAMPLES = 30
LEVEL_M2 = 0.002
FIRST = np.int64(0)
"""Column; of a type, as a literal is not, so that `points_of_row` is compiled once."""
SUPPORT_BITS = ~(np.uint64(1) << WALL_BIT)


@kernel
def fit_supports(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    heights_m: NDArray[np.float64],
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Plane of each support (K, 3): its height is a x + b y + c, x and y from the raster's corner.

    Poses that are tilted by a degree lift the far end of a table by more than a magazine.
    """
    n = len(heights_m)
    planes = np.zeros((n, 3))
    planes[:, 2] = heights_m
    xyh, bits = _over_raster(depth_m, intrinsics, T_map_camera, raster, origin_xy)
    for near in (0.020, 0.010):
        sums = np.zeros((n, 9))
        for i in range(len(bits)):
            x, y, h = xyh[i, 0], xyh[i, 1], xyh[i, 2]
            left, k = bits[i], 0
            while left != 0:
                if left & np.uint64(1):
                    p = planes[k]
                    if abs(h - (p[0] * x + p[1] * y + p[2])) < near:
                        s = sums[k]
                        s[0] += x * x
                        s[1] += x * y
                        s[2] += x
                        s[3] += y * y
                        s[4] += y
                        s[5] += 1.0
                        s[6] += x * h
                        s[7] += y * h
                        s[8] += h
                left >>= np.uint64(1)
                k += 1
        for k in range(n):
            if sums[k, 5] > MIN_SAMPLES:
                _refit(sums[k], planes[k])
    return planes


@kernel
def _over_raster(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.uint64]]:
    """Pixels over a support: x, y from the raster's corner and height (N, 3); bits."""
    rows, cols = depth_m.shape
    xyh, bits, n = np.empty((depth_m.size, 3)), np.empty(depth_m.size, np.uint64), 0
    row, ox, oy = (
        np.empty((3, cols), np.float32),
        np.float32(origin_xy[0]),
        np.float32(origin_xy[1]),
    )
    for v in range(rows):
        points_of_row(depth_m, v, intrinsics, T_map_camera, row, FIRST, cols)
        for u in range(cols):
            if depth_m[v, u] <= 0:
                continue
            x, y = row[0, u] - ox, row[1, u] - oy
            i, j = int(x * CELLS_PER_M), int(y * CELLS_PER_M)
            if not (0 <= i < raster.shape[0] and 0 <= j < raster.shape[1]):
                continue
            over = raster[i, j] & SUPPORT_BITS
            if over != 0:
                xyh[n, 0], xyh[n, 1], xyh[n, 2], bits[n] = x, y, row[2, u], over
                n += 1
    return xyh[:n], bits[:n]


@kernel
def _refit(sums: NDArray[np.float64], plane: NDArray[np.float64]) -> None:
    """Least squares of height on x and y from their sums; a steep plane leaves things as they were.

    `sums` (9,) of xx, xy, x, yy, y, 1, xh, yh, h.
    """
    weight = sums[5]
    mx, my, mh = sums[2] / weight, sums[4] / weight, sums[8] / weight
    # a slope that noise alone could give is held at level
    xx = sums[0] + LEVEL_M2 * weight - weight * mx * mx
    yy = sums[3] + LEVEL_M2 * weight - weight * my * my
    xy = sums[1] - weight * mx * my
    xh, yh = sums[6] - weight * mx * mh, sums[7] - weight * my * mh
    det = xx * yy - xy * xy
    a, b = (xh * yy - yh * xy) / det, (yh * xx - xh * xy) / det
    if a * a + b * b < MAX_SLOPE * MAX_SLOPE:
        plane[0], plane[1], plane[2] = a, b, mh - a * mx - b * my


@kernel
def label_things(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    planes: NDArray[np.float64],
    large: NDArray[np.bool_],
    roots: NDArray[np.int64],
    raster: NDArray[np.uint64],
    origin_xy: NDArray[np.float64],
    slope: NDArray[np.float64],
    low_m: float,
    high_m: float,
    noise: float,
) -> tuple[
    NDArray[np.int16], NDArray[np.float32], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]
]:
    """Say which support each pixel's point stands on, from 1, and how high over what carries that.

    Returns labels (H, W), 0 where there is none, -1 on a support or the floor itself, ON_WALL on
    an upright plane; heights over the support that carries all below (see `roots_of`), (H, W)
    float32, m, undefined where nothing stands; and of what stands, in the order of the image,
    columns, rows and that support, from 0, all (N,).

    `slope` (3,): what one metre of depth changes in height is slope . (u, v, 1).
    """
    rows, cols = depth_m.shape
    ox, oy = np.float32(origin_xy[0]), np.float32(origin_xy[1])
    row, squares = np.empty((3, cols), np.float32), np.empty(cols, np.int32)
    labels = np.empty((rows, cols), np.int16)
    overs = np.empty((rows, cols), np.float32)
    us, vs, ks = np.empty((3, rows * cols), np.int32)
    over_squares, n = raster.ravel(), 0
    for v in range(rows):
        points_of_row(depth_m, v, intrinsics, T_map_camera, row, FIRST, cols)
        _squares_of_row(depth_m[v], row, ox, oy, raster.shape, labels[v], squares)
        for u in range(cols):
            bits = over_squares[squares[u]]
            if bits == 0:
                continue
            if bits >> WALL_BIT != 0:
                labels[v, u] = ON_WALL
                continue
            z, x, y, h = depth_m[v, u], row[0, u] - ox, row[1, u] - oy, row[2, u]
            rise = abs(slope[0] * u + slope[1] * v + slope[2])
            margin = max(low_m, 3.0 * noise * depth_sigma(z) * rise)
            k = -1
            while bits != 0:
                k += 1
                under = bits & np.uint64(1)
                bits >>= np.uint64(1)
                if under == 0:
                    continue
                over = h - (planes[k, 0] * x + planes[k, 1] * y + planes[k, 2])
                if over > high_m:
                    break
                if over > margin:
                    r = roots[k]
                    labels[v, u] = k + 1
                    overs[v, u] = h - (planes[r, 0] * x + planes[r, 1] * y + planes[r, 2])
                    us[n], vs[n], ks[n] = u, v, r
                    n += 1
                    break
                if over > -margin:
                    labels[v, u] = -1
                    if large[k]:
                        break
    return labels, overs, us[:n], vs[:n], ks[:n]


@kernel
def _squares_of_row(
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
    origin_x: np.float32,
    origin_y: np.float32,
    shape: tuple[int, int],
    labels: NDArray[np.int16],
    squares: NDArray[np.int32],
) -> None:
    """Over which square of a raster (flat) each point of a row (3, W) lies; -1 in `labels`: floor.

    Square 0, at the padded corner, is that of the floor, of what lies off the raster, and where
    nothing returned. No branches: the compiler makes vector instructions of it.
    """
    rows, cols = np.int32(shape[0]), np.int32(shape[1])
    floor = np.float32(FLOOR_M)
    for u in range(len(depth_m)):
        seen = depth_m[u] > 0
        high = points[2, u] >= floor
        labels[u] = np.int16(-1) if seen & (not high) else np.int16(0)
        i = np.int32((points[0, u] - origin_x) * CELLS_PER_M)
        j = np.int32((points[1, u] - origin_y) * CELLS_PER_M)
        on = seen & high & (i >= 0) & (i < rows) & (j >= 0) & (j < cols)
        squares[u] = i * cols + j if on else np.int32(0)
