"""Things off every support: on one that is out of sight (paper Fig. 2, row 1), or on the floor."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body, Stand
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_things.above import FLOOR_M
from afkb_things.apart import Loose, apart_from_above
from afkb_things.scene import Scene

TALLEST_M = 0.5
BIN_M = (0.15, 0.85)
"""Lowest and highest rim of what stands on the floor: bins, baskets, boxes."""
LOW_M, HIGH_M = (0.25, FLOOR_M), (1.8, BIN_M[1] + 0.1)
"""Between these heights is looked for what stands on hidden supports, and for what on the floor."""
HIDDEN_SHARE = 0.6
"""Share of a thing's lower outline that something nearer must cover."""


def loose_of(scene: Scene) -> Loose:
    """All that things are looked for in, whether on hidden supports or on the floor."""
    return Loose.of(scene, min(LOW_M), max(HIGH_M))


def things_on_hidden_supports(scene: Scene, loose: Loose, min_pixels: int) -> Iterator[Body]:
    """Compact bodies that stand apart, seen from above, and whose foot something nearer covers."""
    for part in apart_from_above(loose, LOW_M[0], HIGH_M[0], min_pixels):
        u0, _, u1, _ = extent(part.u, part.v)
        seen = (part.u, part.v, scene.depth_m, u0, u1, scene.noise, loose.thin)
        if np.ptp(part.heights_m) > TALLEST_M or _hidden_below(*seen) < HIDDEN_SHARE:
            continue
        u, v = part.pixels(scene)
        if len(u) >= min_pixels:
            shape = scene.depth_m.shape
            yield Body(u, v, *scene.at(u, v), shape, Stand.HIDDEN, None, noise=scene.noise)


def things_on_the_floor(scene: Scene, loose: Loose, min_pixels: int) -> Iterator[Body]:
    """Compact bodies that stand apart on the floor, as bins and baskets do."""
    for part in apart_from_above(loose, LOW_M[1], HIGH_M[1], min_pixels):
        if not BIN_M[0] < percentile(part.heights_m, 98.0) < BIN_M[1]:
            continue
        u, v = part.pixels(scene)
        if len(u) >= min_pixels:
            shape = scene.depth_m.shape
            yield Body(u, v, *scene.at(u, v), shape, Stand.ON_FLOOR, 0.0, noise=scene.noise)


@kernel
def _hidden_below(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    u0: int,
    u1: int,
    noise: float,
    thin: int,
) -> float:
    """Share of a thing's image columns below which something clearly nearer stands.

    Of each `thin` of its rows, one is known.
    """
    rows = depth_m.shape[0]
    lowest = np.full(u1 - u0, -1)
    for k in range(len(u)):
        lowest[u[k] - u0] = max(lowest[u[k] - u0], v[k])
    hidden = total = 0
    for c in range(u1 - u0):
        if lowest[c] < 0:
            continue
        total += 1
        z = depth_m[lowest[c], u0 + c]
        for i in range(lowest[c] + thin, min(lowest[c] + thin + 6, rows)):
            below = depth_m[i, u0 + c]
            if below > 0:
                hidden += below < z - 0.03 - 3.0 * noise * depth_sigma(z)
                break
    return hidden / max(total, 1)
