"""Planes of small cells of a depth image: the first, coarse look at every surface in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_surfaces.moments import CELL, ONE, ZERO, N, moments_of_row
from afkb_surfaces.noise import LEAST_WINDOW, noise_of, room_for, sigma_of
from afkb_surfaces.windows import (
    MEAN_U,
    MEAN_V,
    MEAN_W,
    N_FIT,
    SLOPE_U,
    SLOPE_V,
    SPREAD,
    VARIANCE,
    WEIGHT,
    fit_moments,
    fit_windows,
)

A, B, C, NX, NY, NZ, X, Y, Z, DEPTH, SIGMA_TILT, COUNT = range(12)
"""Rows of the planes: 1/z = A u + B v + C; normal, centroid (map frame); what they are worth."""
N_ROWS = 12

FLAT = 1.6
"""A plane fits where the pixels stray from it by at most this many times the noise."""
LEAST_CELL = 0.5
"""Share of the pixels of a cell that must have depth for a plane to be fitted to it alone."""
LEAST_OWN = 2
"""A cell of fewer pixels with depth isn't told by the window around it."""
MIDDLE, TINY = np.float32(0.5 * (CELL - 1)), np.float32(1e-12)


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """Cells of a depth image.

    - `planes`: (rows, N_ROWS, cols) float32; COUNT is 0 where no plane fits.
    - `size_px`: pixels along a cell. `noise`: how many times noisier than `depth_sigma` the view
      is, 1 or more.
    """

    planes: NDArray[np.float32]
    size_px: int
    noise: float

    @classmethod
    def of(
        cls,
        depth_m: NDArray[np.float32],
        intrinsics: NDArray[np.float64],
        T_map_camera: NDArray[np.float64],
        softness_m: float,
        thin: int,
    ) -> Cells:
        """Planes of the cells of a depth image (H, W); `intrinsics` is fx, fy, cx, cy.

        Every `thin`-th row and column is looked at: a cell is that many times larger.
        """
        height, width = (n // thin * thin for n in depth_m.shape)
        coarse = np.ascontiguousarray(depth_m[:height:thin, :width:thin], dtype=np.float32)
        noise = noise_of(coarse)
        planes = cell_planes(coarse, intrinsics / thin, T_map_camera, noise, softness_m)
        if thin > 1:
            planes[:, :2] /= thin
        return cls(planes, CELL * thin, noise)


@kernel
def cell_planes(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    noise: float,
    softness_m: float,
) -> NDArray[np.float32]:
    """Planes (rows, N_ROWS, cols) of the cells of a depth image, map frame; normals point back.

    Row by row, with three rows of moments at hand, which the processor's nearest memory holds.
    """
    rows, cols = depth_m.shape[0] // CELL, depth_m.shape[1] // CELL
    planes = np.empty((rows, N_ROWS, cols), np.float32)
    pixels, moments, down, window = room_for(cols)
    fit, own = np.empty((N_FIT, cols), np.float32), np.empty((N_FIT, cols + 2), np.float32)
    camera, T = intrinsics.astype(np.float32), T_map_camera.astype(np.float32)
    for r in range(min(rows, 1)):
        moments_of_row(depth_m, r, pixels, moments[1])
    for r in range(rows):
        above, here, below = moments[r % 3], moments[(r + 1) % 3], moments[(r + 2) % 3]
        if r + 1 < rows:
            moments_of_row(depth_m, r + 1, pixels, below)
        else:
            below[:] = ZERO
        fit_windows(above, here, below, down, window, fit)
        fit_moments(here, own)
        _keep_flat(fit, own, here[N], np.float32(FLAT * noise), np.float32(softness_m))
        _write_places(fit, planes[r], r, camera, T)
        _write_normals(fit, planes[r], camera, T, np.float32(noise))
    return planes


@kernel
def _keep_flat(
    fit: NDArray[np.float32],
    own: NDArray[np.float32],
    seen: NDArray[np.float32],
    times: np.float32,
    softness_m: np.float32,
) -> None:
    """Of a row of cells, put a cell's own fit where its window's is none; WEIGHT 0 if neither is.

    `fit` (N_FIT, cols) of windows; `own` (N_FIT, cols + 2), and `seen`, the number of pixels with
    depth, of the cells themselves.
    """
    cols = fit.shape[1]
    flat, flat_own = np.empty(cols, np.bool_), np.empty(cols + 2, np.bool_)
    _find_flat(fit, times, softness_m, flat)
    _find_flat(own, times, softness_m, flat_own)
    least = np.float32(LEAST_WINDOW * 9 * CELL * CELL)
    least_own = np.float32(LEAST_CELL * CELL * CELL)
    for c in range(cols):
        if flat[c] and seen[c + 1] >= LEAST_OWN and fit[WEIGHT, c] >= least:
            continue
        if flat_own[c + 1] and seen[c + 1] >= least_own:
            for k in range(N_FIT):
                fit[k, c] = own[k, c + 1]
        else:
            fit[WEIGHT, c] = ZERO


@kernel
def _find_flat(
    fit: NDArray[np.float32], times: np.float32, softness_m: np.float32, flat: NDArray[np.bool_]
) -> None:
    """Of a row of fits, those whose pixels stray no more than noise and softness allow."""
    for c in range(len(flat)):
        w = fit[MEAN_W, c]
        z = ONE / max(w, TINY)
        most = (times * sigma_of(z) + softness_m) * w * w
        flat[c] = fit[VARIANCE, c] <= most * most


@kernel
def _write_places(
    fit: NDArray[np.float32],
    out: NDArray[np.float32],
    r: int,
    camera: NDArray[np.float32],
    T: NDArray[np.float32],
) -> None:
    fx, fy, cx, cy = camera[0], camera[1], camera[2], camera[3]
    R00, R01, R02, X0 = T[0, 0], T[0, 1], T[0, 2], T[0, 3]
    R10, R11, R12, Y0 = T[1, 0], T[1, 1], T[1, 2], T[1, 3]
    R20, R21, R22, Z0 = T[2, 0], T[2, 1], T[2, 2], T[2, 3]
    v0, u0 = np.float32(r * CELL) + MIDDLE, MIDDLE
    for c in range(fit.shape[1]):
        a, b, w = fit[SLOPE_U, c], fit[SLOPE_V, c], fit[MEAN_W, c]
        u, v = np.float32(c * CELL) + u0 + fit[MEAN_U, c], v0 + fit[MEAN_V, c]
        z = ONE / max(w, TINY)
        x, y = (u - cx) / fx * z, (v - cy) / fy * z
        out[A, c], out[B, c], out[C, c] = a, b, w - a * u - b * v
        out[X, c] = R00 * x + R01 * y + R02 * z + X0
        out[Y, c] = R10 * x + R11 * y + R12 * z + Y0
        out[Z, c] = R20 * x + R21 * y + R22 * z + Z0
        out[DEPTH, c], out[COUNT, c] = z, fit[WEIGHT, c]


@kernel
def _write_normals(
    fit: NDArray[np.float32],
    out: NDArray[np.float32],
    camera: NDArray[np.float32],
    T: NDArray[np.float32],
    noise: np.float32,
) -> None:
    """Normals, and how wrong they are; after `_write_places`."""
    fx, fy, cx, cy = camera[0], camera[1], camera[2], camera[3]
    R00, R01, R02 = T[0, 0], T[0, 1], T[0, 2]
    R10, R11, R12 = T[1, 0], T[1, 1], T[1, 2]
    R20, R21, R22 = T[2, 0], T[2, 1], T[2, 2]
    for c in range(fit.shape[1]):
        px, py = out[A, c] * fx, out[B, c] * fy
        pz = out[C, c] + out[A, c] * cx + out[B, c] * cy
        by_length = ONE / np.sqrt(max(px * px + py * py + pz * pz, TINY))
        out[NX, c] = -(R00 * px + R01 * py + R02 * pz) * by_length
        out[NY, c] = -(R10 * px + R11 * py + R12 * pz) * by_length
        out[NZ, c] = -(R20 * px + R21 * py + R22 * pz) * by_length
        spread = np.sqrt(max(fit[WEIGHT, c] * fit[SPREAD, c], ONE))
        sigma, w = noise * sigma_of(out[DEPTH, c]), fit[MEAN_W, c]
        out[SIGMA_TILT, c] = sigma * w * w * fx * by_length / spread
