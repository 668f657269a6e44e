"""How noisy a view's depth is, beside the sensor's model."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.per_view import once_per_view
from afkb_mapping.sensor_noise import depth_sigma

LEAST_SAMPLES = 20
ROWS_APART, COLUMNS_APART = 12, 5
MEDIAN_OF_SECOND_DIFFERENCE = 1.652
"""Median size of z[u-1] - 2 z[u] + z[u+1] for white noise of one standard deviation."""


@once_per_view
def noise_scale_of(view: View) -> float:
    """`noise_scale` of a view that has depth, for all detectors that ask."""
    assert view.depth_m is not None
    return noise_scale(view.depth_m)


@kernel
def noise_scale(depth_m: NDArray[np.float32]) -> float:
    """How many times worse than its model a view's noise is; 1 where it is no worse.

    Second differences along rows are blind to slant and, at the scale of pixels, to curvature.
    """
    rows, cols = depth_m.shape
    ratios, n = np.empty((rows // ROWS_APART + 1) * (cols // COLUMNS_APART + 1)), 0
    for v in range(0, rows, ROWS_APART):
        for u in range(COLUMNS_APART, cols - 1, COLUMNS_APART):
            left, z, right = depth_m[v, u - 1], depth_m[v, u], depth_m[v, u + 1]
            if left > 0 and z > 0 and right > 0:
                size = abs(left - 2.0 * z + right)
                ratios[n] = size / (MEDIAN_OF_SECOND_DIFFERENCE * depth_sigma(z))
                n += 1
    return max(1.0, percentile(ratios[:n], 50.0)) if n >= LEAST_SAMPLES else 1.0
