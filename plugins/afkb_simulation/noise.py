"""What real depth cameras and lasers do to exact measurements."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_simulation.casting import Hits
from afkb_simulation.world_file import SensorNoise

_EDGE_STEP = 0.03


def noisy_depth(
    hits: Hits, focal_px: float, noise: SensorNoise, rng: np.random.Generator
) -> NDArray[np.float32]:
    """(H, W) depth as a structured-light camera returns it, m; 0 where nothing came back.

    Axial noise grows with distance (Nguyen, Izadi, Lovell 2012), disparity comes in steps, and
    edges and surfaces seen at a grazing angle drop out.
    """
    near, far = noise.range
    z = np.where(np.isfinite(hits.distances), hits.distances, np.float32(0))
    sigma = noise.axial_m + noise.axial_per_m2 * np.square(z - np.float32(0.4))
    blurred = z + sigma * rng.standard_normal(z.shape, dtype=np.float32)
    measured = _quantised(blurred.astype(np.float32), focal_px, noise)
    lost = (z <= 0) | (measured < near) | (measured > far)
    lost |= hits.cosines < math.sin(math.radians(noise.grazing_deg))
    lost |= _at_edge(z) & (rng.random(z.shape, dtype=np.float32) < noise.edge_dropout)
    return np.where(lost, 0, measured).astype(np.float32)


def _quantised(z: NDArray[np.float32], focal_px: float, noise: SensorNoise) -> NDArray[np.float32]:
    if noise.disparity_step_px == 0:
        return z
    steps = focal_px * noise.baseline_m / noise.disparity_step_px
    counted = np.rint(steps / np.maximum(z, 0.05))
    return (steps / np.maximum(counted, 1)).astype(np.float32)


def _at_edge(z: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Pixels beside a depth jump of more than 3 % (both sides of it)."""
    edge = np.zeros(z.shape, dtype=np.bool_)
    across = np.abs(np.diff(z, axis=1)) > _EDGE_STEP * z[:, 1:]
    down = np.abs(np.diff(z, axis=0)) > _EDGE_STEP * z[1:]
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge


def noisy_ranges(
    hits: Hits, limits: tuple[float, float], noise: SensorNoise, rng: np.random.Generator
) -> NDArray[np.float32]:
    """(N,) laser ranges, m; inf where nothing came back within the limits."""
    ranges = hits.distances + noise.laser_m * rng.standard_normal(hits.distances.shape)
    lost = ~(np.isfinite(ranges) & (ranges >= limits[0]) & (ranges < limits[1]))
    return np.where(lost, np.inf, ranges).astype(np.float32)
