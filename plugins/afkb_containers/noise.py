"""How noisy the depth of one body is, as it is seen: the sensor's model, or worse."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile

MOST_SAMPLES = 600
LEAST_SAMPLES = 20
MEDIAN_OF_SECOND_DIFFERENCE = 1.652
"""Median size of z[u-1] - 2 z[u] + z[u+1] for white noise of one standard deviation."""


def noise_of(body: Body, depth_m: NDArray[np.float32]) -> float:
    """Standard deviation of a body's depth, m: what the model says, or what is seen if larger.

    Second differences along rows are blind to its slant and, at the scale of pixels, to its
    curvature; so a sensor that is worse than the model shows in them, and no shape does.
    """
    thin = max(1, len(body.u) // MOST_SAMPLES)
    differences = _second_differences(body.u[::thin], body.v[::thin], depth_m)
    if len(differences) < LEAST_SAMPLES:
        return body.sigma_m
    return max(body.sigma_m, percentile(differences, 50.0) / MEDIAN_OF_SECOND_DIFFERENCE)


@kernel
def _second_differences(
    u: NDArray[np.int32], v: NDArray[np.int32], depth_m: NDArray[np.float32]
) -> NDArray[np.float64]:
    """Sizes of second differences along rows at pixels whose both neighbours returned."""
    out, n = np.empty(len(u)), 0
    for k in range(len(u)):
        if not 0 < u[k] < depth_m.shape[1] - 1:
            continue
        left, right = depth_m[v[k], u[k] - 1], depth_m[v[k], u[k] + 1]
        if left > 0 and right > 0:
            out[n] = abs(left - 2.0 * depth_m[v[k], u[k]] + right)
            n += 1
    return out[:n]
