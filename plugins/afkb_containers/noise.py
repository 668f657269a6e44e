"""Which bodies are rougher than their view is noisy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.view_noise import LEAST_SAMPLES, MEDIAN_OF_SECOND_DIFFERENCE

MOST_SAMPLES = 600


@dataclass(frozen=True, slots=True)
class Noise:
    """Standard deviation of a body's depth (m), and how much rougher it is than the view."""

    sigma_m: float
    roughness: float


def noise_of(body: Body, depth_m: NDArray[np.float32], scale: float) -> Noise:
    """The noise of a body in a view whose noise is `scale` times the model's, or more if seen.

    Racks, leaves and heaps of small things are rougher than their view; cartons and cups are not.
    """
    thin = max(1, len(body.u) // MOST_SAMPLES)
    u, v = np.ascontiguousarray(body.u[::thin]), np.ascontiguousarray(body.v[::thin])
    ratios = _noise_over_model(u, v, depth_m)
    own = percentile(ratios, 50.0) if len(ratios) >= LEAST_SAMPLES else scale
    return Noise(body.sigma_m * max(scale, own), own / scale)


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
