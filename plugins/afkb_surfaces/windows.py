"""Planes of three by three cells around each cell, by least squares from their moments.

All arithmetic is in pixels from the middle of the cell, so that single precision suffices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_surfaces.moments import (
    CELL,
    ONE,
    SU,
    SUU,
    SUV,
    SUW,
    SV,
    SVV,
    SVW,
    SW,
    SWW,
    ZERO,
    N,
)

SLOPE_U, SLOPE_V, MEAN_U, MEAN_V, MEAN_W, VARIANCE, SPREAD, WEIGHT = range(8)
"""Of a fit: slopes of w, the means of u, v and w, variance of w about the plane, the smaller
variance of u and v, and the number of pixels."""
N_FIT = 8

ONE_CELL, TWO_CELLS = np.float32(CELL), np.float32(2 * CELL)
CELL_SQUARED = np.float32(CELL * CELL)
LEAST_DET = np.float32(0.05)
"""Pixels all in a row give no plane."""


@kernel
def fit_windows(
    above: NDArray[np.float32],
    here: NDArray[np.float32],
    below: NDArray[np.float32],
    down: NDArray[np.float32],
    window: NDArray[np.float32],
    fit: NDArray[np.float32],
) -> None:
    """Write the fits of the windows of three by three cells around a row of cells.

    `above`, `here`, `below`: (10, cols + 2) moments of three rows; `fit`: (N_FIT, cols), WEIGHT 0
    where there is none. `down` (10, cols + 2) and `window` (10, cols) are room to work in.
    """
    _add_rows(above, here, below, down)
    _add_columns(down, window)
    fit_moments(window, fit)


@kernel
def _add_rows(
    above: NDArray[np.float32],
    here: NDArray[np.float32],
    below: NDArray[np.float32],
    out: NDArray[np.float32],
) -> None:
    """Moments of three cells one above the other, about the middle of the second."""
    for k in (N, SU, SUU, SW, SUW, SWW):
        a, b, c, o = above[k], here[k], below[k], out[k]
        for i in range(len(o)):
            o[i] = a[i] + b[i] + c[i]
    for k, by in ((SV, N), (SUV, SU), (SVW, SW)):
        a, b, c, o = above[k], here[k], below[k], out[k]
        up, down = above[by], below[by]
        for i in range(len(o)):
            o[i] = a[i] + b[i] + c[i] + ONE_CELL * (down[i] - up[i])
    a, b, c, o = above[SVV], here[SVV], below[SVV], out[SVV]
    up, down, n_up, n_down = above[SV], below[SV], above[N], below[N]
    for i in range(len(o)):
        shift = TWO_CELLS * (down[i] - up[i]) + CELL_SQUARED * (n_up[i] + n_down[i])
        o[i] = a[i] + b[i] + c[i] + shift


@kernel
def _add_columns(x: NDArray[np.float32], out: NDArray[np.float32]) -> None:
    """Moments of three cells side by side, about the middle of the second."""
    for k in (N, SV, SVV, SW, SVW, SWW):
        a, o = x[k], out[k]
        for i in range(len(o)):
            o[i] = a[i] + a[i + 1] + a[i + 2]
    for k, by in ((SU, N), (SUV, SV), (SUW, SW)):
        a, o, b = x[k], out[k], x[by]
        for i in range(len(o)):
            o[i] = a[i] + a[i + 1] + a[i + 2] + ONE_CELL * (b[i + 2] - b[i])
    a, o, b, n = x[SUU], out[SUU], x[SU], x[N]
    for i in range(len(o)):
        shift = TWO_CELLS * (b[i + 2] - b[i]) + CELL_SQUARED * (n[i] + n[i + 2])
        o[i] = a[i] + a[i + 1] + a[i + 2] + shift


@kernel
def fit_moments(m: NDArray[np.float32], fit: NDArray[np.float32]) -> None:
    """Least squares of w on (u, v) from moments (10, n) into fits (N_FIT, n)."""
    for i in range(m.shape[1]):
        share = ONE / max(m[N, i], ONE)
        mu, mv, mw = m[SU, i] * share, m[SV, i] * share, m[SW, i] * share
        uu, uv = m[SUU, i] * share - mu * mu, m[SUV, i] * share - mu * mv
        vv, ww = m[SVV, i] * share - mv * mv, m[SWW, i] * share - mw * mw
        uw, vw = m[SUW, i] * share - mu * mw, m[SVW, i] * share - mv * mw
        det = uu * vv - uv * uv
        by_det = ONE / max(det, LEAST_DET)
        a, b = (uw * vv - vw * uv) * by_det, (vw * uu - uw * uv) * by_det
        fit[SLOPE_U, i], fit[SLOPE_V, i] = a, b
        fit[MEAN_U, i], fit[MEAN_V, i], fit[MEAN_W, i] = mu, mv, mw
        fit[VARIANCE, i] = max(ww - a * uw - b * vw, ZERO)
        fit[SPREAD, i] = min(uu, vv)
        fit[WEIGHT, i] = m[N, i] if det > LEAST_DET else ZERO
