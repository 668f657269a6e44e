"""Planes of small cells of a depth image: the first, coarse look at every surface in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.moments import CELL, ONE, ZERO, cell_moments
from afkb_surfaces.windows import (
    MEAN_U,
    MEAN_V,
    MEAN_W,
    SLOPE_U,
    SLOPE_V,
    SPREAD,
    VARIANCE,
    WEIGHT,
    cell_fit,
    window_fits,
)

A, B, C, NX, NY, NZ, X, Y, Z, DEPTH, SIGMA_TILT, COUNT = range(12)
"""Rows of the planes: 1/z = A u + B v + C; normal, centroid (map frame); what they are worth."""
N_ROWS = 12

FLAT = 1.6
"""A plane fits where the pixels stray from it by at most this many times the noise."""
LEAST_WINDOW, LEAST_CELL = 0.3, 0.5
"""Share of the pixels of a window, and of a cell, that must have depth for a plane to be fitted;
half of them may be missing anywhere."""
MIDDLE, TINY = np.float32(0.5 * (CELL - 1)), np.float32(1e-12)
MOST_NOISE = 4.0
"""A sensor, or a scene of leaves and tangles, may seem this much noisier than a Kinect."""
QUIET_SHARE = 0.35
"""At least this share of a view's windows is taken to lie on planes: they show the noise."""


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
        moments = cell_moments(coarse)
        fits = window_fits(moments)
        noise = noise_of(fits)
        keep_flat(fits, moments, noise, softness_m)
        planes = cell_planes(fits, intrinsics / thin, T_map_camera, noise)
        planes[:, :2] /= thin
        return cls(planes, CELL * thin, noise)


@kernel
def noise_of(fits: NDArray[np.float32]) -> float:
    """How many times noisier a view is than `depth_sigma` says, between 1 and MOST_NOISE."""
    bins, n = np.zeros(64, np.int64), 0
    least = np.float32(9 * CELL * CELL * LEAST_WINDOW)
    for r in range(1, fits.shape[0], 2):
        for c in range(1, fits.shape[2], 2):
            if fits[r, WEIGHT, c] < least:
                continue
            z = ONE / fits[r, MEAN_W, c]
            ratio = np.sqrt(fits[r, VARIANCE, c]) * z * z / depth_sigma(z)
            bins[min(int(ratio * 8.0), 63)] += 1
            n += 1
    below = 0
    for k in range(64):
        below += bins[k]
        if below > QUIET_SHARE * n:
            return min(max((k + 1) / 8.0, 1.0), MOST_NOISE)
    return 1.0


@kernel
def keep_flat(
    fits: NDArray[np.float32], moments: NDArray[np.float32], noise: float, softness_m: float
) -> None:
    """Put a cell's own fit where its window's is none; WEIGHT 0 where that is none either."""
    cols = fits.shape[2]
    flat = np.empty(cols, np.bool_)
    times, soft = np.float32(FLAT * noise), np.float32(softness_m)
    least = np.float32(LEAST_WINDOW * 9 * CELL * CELL)
    for r in range(fits.shape[0]):
        own = moments[r + 1, 0, 1:-1]
        _find_flat(fits[r], times, soft, flat)
        for c in range(cols):
            if flat[c] and own[c] >= CELL and fits[r, WEIGHT, c] >= least:
                continue
            if own[c] >= LEAST_CELL * CELL * CELL:
                cell_fit(moments, r, c, fits)
                _find_flat(fits[r, :, c : c + 1], times, soft, flat[c : c + 1])
                if flat[c]:
                    continue
            fits[r, WEIGHT, c] = ZERO


@kernel
def _find_flat(
    fit: NDArray[np.float32], times: np.float32, softness_m: np.float32, flat: NDArray[np.bool_]
) -> None:
    """Of a row of fits, those whose pixels stray no more than noise and softness allow."""
    for c in range(len(flat)):
        w = fit[MEAN_W, c]
        z = ONE / max(w, TINY)
        most = (times * np.float32(depth_sigma(z)) + softness_m) * w * w
        flat[c] = fit[VARIANCE, c] <= most * most


@kernel
def cell_planes(
    fits: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    noise: float,
) -> NDArray[np.float32]:
    """Planes (rows, N_ROWS, cols) from fits, map frame; the normal points to the camera."""
    rows, cols = fits.shape[0], fits.shape[2]
    planes = np.empty((rows, N_ROWS, cols), np.float32)
    camera, T = intrinsics.astype(np.float32), T_map_camera.astype(np.float32)
    for r in range(rows):
        _write_places(fits[r], planes[r], r, camera, T)
        _write_normals(fits[r], planes[r], camera, T, np.float32(noise))
    return planes


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
        sigma = noise * np.float32(depth_sigma(out[DEPTH, c]))
        out[SIGMA_TILT, c] = sigma * fit[MEAN_W, c] ** 2 * fx * by_length / spread
