"""What is seen right above a body: nothing, as over cans and cartons, or what it carries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_containers.sight import Sight
from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel

TOP_M = 0.012
"""Points this little below a body's top are parts of it."""
LOWEST_M, HIGHEST_M, STEPS = 0.015, 0.060, 8
"""Heights over the top that are looked at: a hand opens a lid there, a shade or a board is near."""
BEFORE_M = 0.25
"""What overhangs a body, a shade or the edge of a board, is nearer by no more than this; what is
nearer still stands before it and tells nothing."""
MOST_PROBES = 60


@dataclass(frozen=True, slots=True)
class Above:
    """Shares of the spots right above a body's top: free, filled, and out of the image.

    The rest lies behind something nearer, or where nothing returned.
    """

    free: float
    filled: float
    outside: float


def above(body: Body, top_m: float, sight: Sight) -> Above:
    """What is seen above a body whose top is at top_m, heights as the body's."""
    free, filled, outside, n = _above(
        body.points, top_m, body.slope, sight.depth_m, sight.intrinsics, sight.T_camera_map
    )
    return Above(free / max(n, 1), filled / max(n, 1), outside / max(n, 1))


@kernel
def _above(
    points: NDArray[np.float64],
    top_m: float,
    slope: tuple[float, float, float],
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_camera_map: NDArray[np.float64],
) -> tuple[int, int, int, int]:
    """Spots above the top: free, filled, out of the image, and all that were looked at."""
    count = 0
    for k in range(len(points)):
        count += points[k, 2] > top_m - TOP_M
    every, seen = max(1, count // MOST_PROBES), 0
    free = filled = outside = n = 0
    T = T_camera_map
    for k in range(len(points)):
        if points[k, 2] <= top_m - TOP_M:
            continue
        seen += 1
        if seen % every:
            continue
        x, y = points[k, 0], points[k, 1]
        tilt = slope[0] * x + slope[1] * y + slope[2]
        for step in range(STEPS):
            over = LOWEST_M + (HIGHEST_M - LOWEST_M) * step / (STEPS - 1)
            h = top_m + over + tilt
            z = T[2, 0] * x + T[2, 1] * y + T[2, 2] * h + T[2, 3]
            n += 1
            if z <= 0:
                continue
            u = (T[0, 0] * x + T[0, 1] * y + T[0, 2] * h + T[0, 3]) / z * intrinsics[0]
            v = (T[1, 0] * x + T[1, 1] * y + T[1, 2] * h + T[1, 3]) / z * intrinsics[1]
            i, j = round(v + intrinsics[3]), round(u + intrinsics[2])
            if not (0 <= i < depth_m.shape[0] and 0 <= j < depth_m.shape[1]):
                outside += 1
                continue
            there = depth_m[i, j]
            if there >= z + 0.5 * over:
                free += 1
            elif there > 0 and there > z - BEFORE_M:
                filled += 1
    return free, filled, outside, n
