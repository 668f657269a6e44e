"""What a patch of cells measures: height, tilt, extent, each worked out once for all patches."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentiles
from afkb_surfaces.cells import COUNT, DEPTH, X, Y, Z
from afkb_surfaces.moments import CELL

HEIGHT_BIN_M = 0.004
MOST_CELLS = 1000
"""Of a patch with more cells a share of at least half as many tells its height and its plane."""
SAMPLES = 500
"""Cells of which percentiles are taken; more would tell no more."""

CELLS, HEIGHT, TILT, RMS, NEAREST, MEDIAN, LENGTH, AREA, PIXELS = range(9)
"""Columns: number of cells; height where most of it lies, m; tilt, rad; rms about its plane, m;
nearest and median depth, m; how long it is in the image, cells; area if it is level, m2; pixels
with depth in its cells, about."""
SLOPE_X, SLOPE_Y, MIDDLE_X, MIDDLE_Y, MIDDLE_Z = range(9, 14)
"""Its plane: z = MIDDLE_Z + SLOPE_X (x - MIDDLE_X) + SLOPE_Y (y - MIDDLE_Y)."""
X0, X1, Y0, Y1, C0, C1, R0, R1 = range(14, 22)
"""What it spans in the map, m, and in cells, both ends included."""
N_MEASURES = 22


@kernel
def measure_patches(
    order: NDArray[np.int64],
    starts: NDArray[np.int64],
    wanted: NDArray[np.bool_],
    planes: NDArray[np.float32],
    least_cells: int,
    cell_rad: float,
    camera_height_m: float,
) -> NDArray[np.float64]:
    """Measures (n_labels, N_MEASURES); CELLS is 0 for those not wanted or of too few cells.

    Flat indexes of the cells of label k are `order[starts[k]:starts[k + 1]]`. `cell_rad`: angle
    that a cell takes up; a level one covers the more, the more grazing it is seen.
    """
    out = np.zeros((len(starts) - 1, N_MEASURES))
    for k in range(len(out)):
        own = order[starts[k] : starts[k + 1]]
        if len(own) < least_cells or not wanted[k]:
            continue
        m = out[k]
        m[CELLS] = len(own)
        p = _look_through(own, planes, m)
        m[HEIGHT] = mode_height(p)
        _fit_plane(p, m)
        thin = (len(p) + SAMPLES - 1) // SAMPLES
        m[NEAREST], m[MEDIAN] = percentiles(p[::thin, 3], 1.0, 50.0)
        m[LENGTH] = _length(p)
        m[AREA] *= cell_rad**2 / max(camera_height_m - m[HEIGHT], 0.01)
    return out


@kernel
def _look_through(
    own: NDArray[np.int64], planes: NDArray[np.float32], m: NDArray[np.float64]
) -> NDArray[np.float64]:
    """x, y, z, depth, column and row of the cells of a patch, or of a share of them: (n, 6).

    Sums and spans are of all cells and go to `m`; AREA yet has to be turned to m2.
    """
    cols, thin = planes.shape[2], 1 + len(own) // MOST_CELLS
    p = np.empty(((len(own) + thin - 1) // thin, 6))
    r = own[0] // cols
    left, right, pixels, cubes = cols, -1, 0.0, 0.0
    x0, x1, y0, y1 = np.inf, -np.inf, np.inf, -np.inf
    for i in range(len(own)):
        while own[i] >= (r + 1) * cols:
            r += 1
        c = own[i] - r * cols
        x, y, z, weight = planes[r, X, c], planes[r, Y, c], planes[r, DEPTH, c], planes[r, COUNT, c]
        left, right = min(left, c), max(right, c)
        x0, x1, y0, y1 = min(x0, x), max(x1, x), min(y0, y), max(y1, y)
        pixels += weight / 9.0 if weight > CELL * CELL else weight
        cubes += z * z * z
        if i % thin == 0:
            q = p[i // thin]
            q[0], q[1], q[2], q[3] = x, y, planes[r, Z, c], z
            q[4], q[5] = c, r
    m[X0], m[X1], m[Y0], m[Y1] = x0, x1, y0, y1
    m[C0], m[C1], m[R0], m[R1] = left, right, own[0] // cols, r
    m[PIXELS], m[AREA] = pixels, cubes
    return p


@kernel
def mode_height(points: NDArray[np.float64]) -> float:
    """Height at which most of a surface (N, 3+) lies: mean of what is around the fullest bin, m."""
    low = high = points[0, 2]
    for n in range(1, len(points)):
        low, high = min(low, points[n, 2]), max(high, points[n, 2])
    counts = np.zeros(int((high - low) / HEIGHT_BIN_M) + 3, np.int64)
    for n in range(len(points)):
        counts[int((points[n, 2] - low) / HEIGHT_BIN_M) + 1] += 1
    best, fullest = 0, -1
    for k in range(1, len(counts) - 1):
        around = counts[k - 1] + counts[k] + counts[k + 1]
        if around > fullest:
            best, fullest = k - 1, around
    centre = low + (best + 0.5) * HEIGHT_BIN_M
    total, count = 0.0, 0
    for n in range(len(points)):
        if abs(points[n, 2] - centre) <= 2.5 * HEIGHT_BIN_M:
            total += points[n, 2]
            count += 1
    return total / count


@kernel
def _fit_plane(p: NDArray[np.float64], m: NDArray[np.float64]) -> None:
    """Least squares of z on x and y of points (N, 3+): middle, slopes, tilt and rms."""
    n = len(p)
    mx = my = mz = 0.0
    for k in range(n):
        mx, my, mz = mx + p[k, 0], my + p[k, 1], mz + p[k, 2]
    mx, my, mz = mx / n, my / n, mz / n
    # the ridge keeps a row of points, which says nothing across itself, level that way
    xx = yy = 1e-6 * n
    xy = xz = yz = zz = 0.0
    for k in range(n):
        x, y, z = p[k, 0] - mx, p[k, 1] - my, p[k, 2] - mz
        xx, xy, yy, xz, yz = xx + x * x, xy + x * y, yy + y * y, xz + x * z, yz + y * z
        zz += z * z
    det = xx * yy - xy * xy
    a, b = (xz * yy - yz * xy) / det, (yz * xx - xz * xy) / det
    m[SLOPE_X], m[SLOPE_Y] = a, b
    m[MIDDLE_X], m[MIDDLE_Y], m[MIDDLE_Z] = mx, my, mz
    m[TILT] = math.atan(math.hypot(a, b))
    m[RMS] = math.sqrt(max(zz - a * xz - b * yz, 0.0) / n)


@kernel
def _length(p: NDArray[np.float64]) -> float:
    """How long a patch is in the image along its main axis, cells; `p` (n, 6) tells its cells."""
    n = len(p)
    sr = sc = srr = src = scc = 0.0
    for i in range(n):
        c, r = p[i, 4], p[i, 5]
        sr, sc = sr + r, sc + c
        srr, src, scc = srr + r * r, src + r * c, scc + c * c
    rr, cc, cross = srr / n - (sr / n) ** 2, scc / n - (sc / n) ** 2, src / n - sr * sc / (n * n)
    turn = 0.5 * math.atan2(2.0 * cross, cc - rr)
    along, up = math.cos(turn), math.sin(turn)
    low, high = np.inf, -np.inf
    for i in range(n):
        t = along * p[i, 4] + up * p[i, 5]
        low, high = min(low, t), max(high, t)
    return high - low + 1.0
