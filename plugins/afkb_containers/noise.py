"""How noisy a view's depth is, and which of its surfaces are rougher than that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma

LEAST_SAMPLES, MOST_SAMPLES = 20, 600
ROWS_APART, COLUMNS_APART = 12, 5
MEDIAN_OF_SECOND_DIFFERENCE = 1.652
"""Median size of z[u-1] - 2 z[u] + z[u+1] for white noise of one standard deviation."""


@dataclass(frozen=True, slots=True)
class Noise:
    """Standard deviation of a body's depth (m), and how much rougher it is than the view."""

    sigma_m: float
    roughness: float


def noise_scale(depth_m: NDArray[np.float32]) -> float:
    """How many times worse than its model a view's noise is; 1 where it is no worse.

    Second differences along rows are blind to slant and, at the scale of pixels, to curvature.
    """
    ratios = _noise_over_model(*_grid(depth_m.shape), depth_m)
    return max(1.0, percentile(ratios, 50.0)) if len(ratios) >= LEAST_SAMPLES else 1.0


def noise_of(body: Body, depth_m: NDArray[np.float32], scale: float) -> Noise:
    """The noise of a body in a view whose noise is `scale` times the model's, or more if seen.

    Racks, leaves and heaps of small things are rougher than their view; cartons and cups are not.
    """
    thin = max(1, len(body.u) // MOST_SAMPLES)
    ratios = _noise_over_model(body.u[::thin], body.v[::thin], depth_m)
    own = percentile(ratios, 50.0) if len(ratios) >= LEAST_SAMPLES else scale
    return Noise(body.sigma_m * max(scale, own), own / scale)


@kernel
def _grid(shape: tuple[int, int]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Columns and rows of pixels that are spread evenly over an image."""
    rows, columns = -(-shape[0] // ROWS_APART), -(-shape[1] // COLUMNS_APART)
    u, v = np.empty(rows * columns, np.int32), np.empty(rows * columns, np.int32)
    for n in range(rows * columns):
        u[n], v[n] = n % columns * COLUMNS_APART, n // columns * ROWS_APART
    return u, v


@kernel
def _noise_over_model(
    u: NDArray[np.int32], v: NDArray[np.int32], depth_m: NDArray[np.float32]
) -> NDArray[np.float64]:
    """Second differences over their median by the model, where both neighbours returned."""
    out, n = np.empty(len(u)), 0
    for k in range(len(u)):
        if not 0 < u[k] < depth_m.shape[1] - 1:
            continue
        left, z, right = depth_m[v[k], u[k] - 1], depth_m[v[k], u[k]], depth_m[v[k], u[k] + 1]
        if left > 0 and z > 0 and right > 0:
            out[n] = abs(left - 2.0 * z + right) / (MEDIAN_OF_SECOND_DIFFERENCE * depth_sigma(z))
            n += 1
    return out[:n]
