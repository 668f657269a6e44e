"""Planes of small cells of a depth image: the first, coarse look at every surface in it.

A plane is linear in inverse depth, and inverse depth has nearly constant noise, so a cell's
plane is an unweighted least-squares fit of 1/z to pixel coordinates.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

CELL = 4
"""Pixels along a cell; its plane is fitted to a window of three by three cells if it can."""

A, B, C, NX, NY, NZ, X, Y, Z, DEPTH, SIGMA_TILT, COUNT = range(12)
"""Columns of a cell: 1/z = A u + B v + C; normal, centroid (map frame); what they are worth."""
N_COLUMNS = 12


@kernel
def cell_sums(depth_m: NDArray[np.float32]) -> NDArray[np.float64]:
    """Moments of each cell: (rows + 2, cols + 2, 10) of n, u, v, w, uu, uv, vv, uw, vw, ww.

    w = 1/z; a margin of one empty cell lies around them.
    """
    rows, cols = depth_m.shape[0] // CELL, depth_m.shape[1] // CELL
    sums = np.zeros((rows + 2, cols + 2, 10))
    for r in range(rows):
        for c in range(cols):
            n = 0
            su = sv = sw = suu = suv = svv = suw = svw = sww = 0.0
            for i in range(r * CELL, (r + 1) * CELL):
                v = float(i)
                for j in range(c * CELL, (c + 1) * CELL):
                    z = depth_m[i, j]
                    if z > 0:
                        u, w = float(j), 1.0 / z
                        n += 1
                        su += u
                        sv += v
                        sw += w
                        suu += u * u
                        suv += u * v
                        svv += v * v
                        suw += u * w
                        svw += v * w
                        sww += w * w
            s = sums[r + 1, c + 1]
            s[0], s[1], s[2], s[3] = n, su, sv, sw
            s[4], s[5], s[6], s[7], s[8], s[9] = suu, suv, svv, suw, svw, sww
    return sums


@kernel
def _fit(s: NDArray[np.float64], plane: NDArray[np.float64]) -> bool:
    """Least squares of w on (u, v) from moments; plane = a, b, c, mean w, rms, variance of v."""
    n = s[0]
    mu, mv, mw = s[1] / n, s[2] / n, s[3] / n
    cuu, cuv, cvv = s[4] / n - mu * mu, s[5] / n - mu * mv, s[6] / n - mv * mv
    cuw, cvw, cww = s[7] / n - mu * mw, s[8] / n - mv * mw, s[9] / n - mw * mw
    det = cuu * cvv - cuv * cuv
    if det < 0.05:
        return False
    a, b = (cuw * cvv - cvw * cuv) / det, (cvw * cuu - cuw * cuv) / det
    plane[0], plane[1], plane[2] = a, b, mw - a * mu - b * mv
    plane[3] = mw
    plane[4] = np.sqrt(max(cww - a * cuw - b * cvw, 0.0))
    plane[5] = min(cuu, cvv)
    plane[6], plane[7] = mu, mv
    return True


@kernel
def cell_planes(
    sums: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    softness_m: float,
) -> NDArray[np.float64]:
    """Plane of each cell (rows, cols, N_COLUMNS), map frame; COUNT is 0 where none fits.

    `intrinsics` is fx, fy, cx, cy; the normal points to the camera.
    """
    fx, fy, cx, cy = intrinsics
    rows, cols = sums.shape[0] - 2, sums.shape[1] - 2
    cells = np.zeros((rows, cols, N_COLUMNS))
    window, plane = np.zeros(10), np.zeros(8)
    column = np.zeros((cols + 2, 10))
    for r in range(rows):
        for c in range(cols + 2):
            for k in range(10):
                column[c, k] = sums[r + 1, c, k] + sums[r, c, k] + sums[r + 2, c, k]
        for c in range(cols):
            if sums[r + 1, c + 1, 0] < CELL:
                continue
            for k in range(10):
                window[k] = column[c + 1, k] + column[c, k] + column[c + 2, k]
            if window[0] < 4.5 * CELL * CELL or not _lies_flat(window, plane, softness_m):
                narrow = sums[r + 1, c + 1]
                if narrow[0] < 0.5 * CELL * CELL or not _lies_flat(narrow, plane, softness_m):
                    continue
                _write(cells[r, c], plane, narrow[0], fx, fy, cx, cy, T_map_camera)
            else:
                _write(cells[r, c], plane, window[0], fx, fy, cx, cy, T_map_camera)
    return cells


@kernel
def _lies_flat(s: NDArray[np.float64], plane: NDArray[np.float64], softness_m: float) -> bool:
    """Whether a plane fits moments as well as noise and softness allow; writes the plane."""
    if not _fit(s, plane):
        return False
    z = 1.0 / plane[3]
    return bool(plane[4] * z * z <= 1.6 * depth_sigma(z) + softness_m)


@kernel
def _write(
    cell: NDArray[np.float64],
    plane: NDArray[np.float64],
    n: float,
    fx: float,
    fy: float,
    cx: float,
    cy: float,
    T: NDArray[np.float64],
) -> None:
    a, b, c, w = plane[0], plane[1], plane[2], plane[3]
    px, py = a * fx, b * fy
    pz = c + a * cx + b * cy
    length = np.sqrt(px * px + py * py + pz * pz)
    z = 1.0 / w
    sigma = depth_sigma(z)
    xc, yc = (plane[6] - cx) / fx * z, (plane[7] - cy) / fy * z
    cell[A], cell[B], cell[C] = a, b, c
    for k in range(3):
        cell[NX + k] = -(T[k, 0] * px + T[k, 1] * py + T[k, 2] * pz) / length
        cell[X + k] = T[k, 0] * xc + T[k, 1] * yc + T[k, 2] * z + T[k, 3]
    cell[DEPTH] = z
    cell[SIGMA_TILT] = sigma / (z * z) * fx / (length * np.sqrt(n * plane[5]))
    cell[COUNT] = n
