"""How noisy a view is: told from how far its pixels stray from planes of small windows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import FLOOR_M, GROWTH_PER_M, NEAREST_M, depth_sigma
from afkb_surfaces.moments import CELL, N_SCRATCH, ONE, moments_of_row
from afkb_surfaces.windows import MEAN_W, N_FIT, VARIANCE, WEIGHT, fit_windows

LEAST_WINDOW = 0.15
"""Share of the pixels of a window that must have depth for a plane to be fitted; three quarters of
them may be missing anywhere."""
MOST_NOISE = 4.0
"""A sensor, or a scene of leaves and tangles, may seem this much noisier than a Kinect."""
QUIET_SHARE = 0.35
"""At least this share of a view's windows is taken to lie on planes: they show the noise."""
NOISE_ROWS = 20
"""Noise is told from every so manieth row of cells."""
SIGMA_FLOOR, SIGMA_GROWTH = np.float32(FLOOR_M), np.float32(GROWTH_PER_M)
SIGMA_NEAREST = np.float32(NEAREST_M)


@kernel
def sigma_of(z_m: np.float32) -> np.float32:
    """`depth_sigma` in single precision, as the loops are that use it."""
    off = z_m - SIGMA_NEAREST
    return SIGMA_FLOOR + SIGMA_GROWTH * off * off


@kernel
def noise_of(depth_m: NDArray[np.float32]) -> float:
    """How many times noisier a view (H, W) is than `depth_sigma` says, between 1 and MOST_NOISE.

    Told from the windows around some rows of cells.
    """
    rows, cols = depth_m.shape[0] // CELL, depth_m.shape[1] // CELL
    pixels, moments, down, window = room_for(cols)
    fit = np.empty((N_FIT, cols), np.float32)
    bins, n = np.zeros(64, np.int64), 0
    for r in range(min(NOISE_ROWS // 2, rows // 2), rows - 1, NOISE_ROWS):
        for i in range(3):
            moments_of_row(depth_m, r + i - 1, pixels, moments[i])
        fit_windows(moments[0], moments[1], moments[2], down, window, fit)
        n += _count_strays(fit, bins)
    below = 0
    for k in range(64):
        below += bins[k]
        if below > QUIET_SHARE * n:
            return min(max((k + 1) / 8.0, 1.0), MOST_NOISE)
    return 1.0


@kernel
def _count_strays(fit: NDArray[np.float32], bins: NDArray[np.int64]) -> int:
    """Count, in bins of an eighth of the noise, by how much pixels stray from a row of fits."""
    n = 0
    least = np.float32(9 * CELL * CELL * LEAST_WINDOW)
    for c in range(1, fit.shape[1], 2):
        if fit[WEIGHT, c] >= least:
            z = ONE / fit[MEAN_W, c]
            bins[min(int(8.0 * np.sqrt(fit[VARIANCE, c]) * z * z / depth_sigma(z)), 63)] += 1
            n += 1
    return n


@kernel
def room_for(
    cols: int,
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """Room for rows of pixels, three rows of moments with a margin of an empty cell, and sums."""
    pixels = np.empty((N_SCRATCH, CELL * cols), np.float32)
    moments = np.zeros((3, 10, cols + 2), np.float32)
    return pixels, moments, np.empty_like(moments[0]), np.empty((10, cols), np.float32)
