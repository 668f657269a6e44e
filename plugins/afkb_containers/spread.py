"""How thick a body is and how far it leans, with what noise adds to its points taken off."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_containers.face import face_of, narrowing_deg
from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentiles

STRAYS = 6.0
"""Percent of points at either end that are left out: sensors mix depths at a body's edge."""
KEPT = 1 - 2 * STRAYS / 100
NOISE_SPAN = 3.11
"""Distance between these percentiles of normal noise, in standard deviations."""
SIGMA_UNSURE = 0.15
"""How far off a sensor's noise model is, as a share of the standard deviation."""
LEAST_SAMPLES, MOST_SAMPLES = 40, 1000
LYING_DEG = 40.0


@dataclass(frozen=True, slots=True)
class Spread:
    """Extents of what is seen of a body along its principal axes, without noise.

    - `thickness_m`: the smallest; `least_m` and `most_m`: what it may be as well, as the noise is
      not known better. A plate that is seen from far may be as thick as noise is.
    - `doubt_m`: how thick noise alone could make a plate.
    - `width_m`: the next larger one. `lean_deg`: of the plane across the smallest, from upright,
      less what is explained as the front of a body that grows narrower upwards, as bottles do;
      where it `lies` rather than stands, 0.
    - `face_share`, `face_lean_deg`: share of the points that are on one plane, and how far that
      leans.
    """

    thickness_m: float
    least_m: float
    most_m: float
    width_m: float
    lean_deg: float
    lies: bool
    doubt_m: float
    face_share: float
    face_lean_deg: float

    @property
    def shape(self) -> float:
        """Thickness as a share of width: near 0 for a plate, to 1 for what is as deep as wide."""
        return self.thickness_m / max(self.width_m, 1e-3)


UNKNOWN = Spread(0.0, 0.0, 0.0, 0.0, 0.0, False, 0.0, 0.0, 0.0)


def spread_of(
    body: Body,
    camera_xyz: NDArray[np.float64],
    sigma_m: float,
    inner: NDArray[np.int64],
    cut: bool = False,
) -> Spread:
    """Spread of a body's points along the axes of their scatter, less a depth noise of sigma_m.

    Noise moves a point along its sight line, so that it adds to the scatter matrix there alone.
    Pixels at its outline, where a sensor mixes what lies before and behind, are not `inner` (M,);
    they don't turn the axes. One that is `cut` by the image seems narrower at its upper end.
    """
    if len(inner) < LEAST_SAMPLES:
        return UNKNOWN
    inner = np.ascontiguousarray(inner[:: max(1, len(inner) // MOST_SAMPLES)])
    scatter, along = _scatter(body.points, body.depth_m, inner, camera_xyz)
    _, axes = np.linalg.eigh(scatter - sigma_m**2 * along)
    normal, across = axes[:, 0].copy(), axes[:, 1].copy()
    points = np.ascontiguousarray(body.points[:: max(1, len(body.u) // MOST_SAMPLES)])
    noise = sigma_m * math.sqrt(float(normal @ along @ normal))
    span = _extent_along(points, normal)
    least, mean, most = (
        _less(span, NOISE_SPAN * noise * (1 + off * SIGMA_UNSURE)) / KEPT for off in (1, 0, -1)
    )
    width = _extent_along(points, across) / KEPT
    lies = _lean(normal) > LYING_DEG
    share, face = face_of(points, normal, noise)
    narrows = 0.0 if cut else narrowing_deg(points, normal)
    sure, unsure = (1 - SIGMA_UNSURE) * noise, (1 + SIGMA_UNSURE) * noise
    return Spread(
        thickness_m=mean,
        least_m=least,
        most_m=most,
        width_m=width,
        lean_deg=0.0 if lies else max(_lean(normal) - narrows, 0.0),
        lies=lies,
        doubt_m=_less(NOISE_SPAN * unsure, NOISE_SPAN * sure) / KEPT,
        face_share=share,
        face_lean_deg=max(_lean(face) - narrows, 0.0),
    )


def _lean(normal: NDArray[np.float64]) -> float:
    """How far a plane leans from upright, degrees."""
    return math.degrees(math.asin(min(abs(float(normal[2])), 1.0)))


def _less(span_m: float, noise_m: float) -> float:
    return math.sqrt(max(span_m**2 - noise_m**2, 0.0))


@kernel
def _extent_along(points: NDArray[np.float64], direction: NDArray[np.float64]) -> float:
    """How far points (N, 3) reach along a direction (3,), strays at either end left out."""
    t = np.empty(len(points))
    for n in range(len(points)):
        t[n] = (
            points[n, 0] * direction[0] + points[n, 1] * direction[1] + points[n, 2] * direction[2]
        )
    low, high = percentiles(t, STRAYS, 100.0 - STRAYS)
    return high - low


@kernel
def _scatter(
    points: NDArray[np.float64],
    depth_m: NDArray[np.float32],
    chosen: NDArray[np.int64],
    camera_xyz: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Scatter (3, 3) of the chosen points about their mean; and of what a metre of depth moves."""
    count = len(chosen)
    centre, total, along, ray = np.zeros(3), np.zeros((3, 3)), np.zeros((3, 3)), np.empty(3)
    for n in chosen:
        for k in range(3):
            centre[k] += points[n, k] / count
    for n in chosen:
        for k in range(3):
            ray[k] = (points[n, k] - camera_xyz[k]) / depth_m[n]
        for k in range(3):
            for m in range(3):
                total[k, m] += (points[n, k] - centre[k]) * (points[n, m] - centre[m])
                along[k, m] += ray[k] * ray[m]
    return total / count, along / count
