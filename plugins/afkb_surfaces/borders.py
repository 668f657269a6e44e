"""What lies beyond the border of a surface in the image: its end, an occluder, or nothing."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

KINDS = ("real", "occluded", "cut", "missing")
REAL, OCCLUDED, CUT, MISSING = range(4)
REACH_PX = 6
"""How far beyond its border a surface is looked for an occluder or missing depth; wider than
speckle, and than the smear of an edge."""
SMEAR_PX = 3
NEARER_M = 0.02
"""What stands on a surface touches it; what hides it lies at least this much before it."""
SIDES = np.array([[1, 0], [-1, 0], [0, 1], [0, -1]], np.int64)


@kernel
def count_borders(
    depth_m: NDArray[np.float32],
    labels: NDArray[np.int32],
    border: NDArray[np.bool_],
    cell: int,
    returning: tuple[int, int, int, int],
    wanted: NDArray[np.bool_],
    reach_px: int,
    noise: float,
) -> NDArray[np.int64]:
    """How much of each wanted label's border is of each kind: (n_labels, 4).

    `border` marks the cells of `cell` pixels that are looked through. A border pixel is followed
    outwards along its row or column; single lost pixels are skipped.
    - beyond what the sensor can return (`returning`: u0, v0, u1, v1): cut,
    - a run of lost pixels: missing,
    - something that begins clearly nearer: occluded; anything else ends it: real.
    """
    counts = np.zeros((len(wanted), 4), np.int64)
    u0, v0, u1, v1 = returning
    every = 2 if cell > 1 else 1
    for r in range(border.shape[0]):
        for c in range(border.shape[1]):
            if not border[r, c]:
                continue
            for v in range(max(r * cell, v0), min((r + 1) * cell, v1), every):
                for u in range(max(c * cell, u0), min((c + 1) * cell, u1), every):
                    label = labels[v, u]
                    if not wanted[label]:
                        continue
                    for k in range(4):
                        i, j = v + SIDES[k, 1] * every, u + SIDES[k, 0] * every
                        if not (v0 <= i < v1 and u0 <= j < u1):
                            counts[label, CUT] += 1
                        elif labels[i, j] != label:
                            kind = _beyond(
                                depth_m, labels, v, u, SIDES[k], returning, reach_px, noise
                            )
                            if kind >= 0:
                                counts[label, kind] += 1
    return counts


@kernel
def _beyond(
    depth_m: NDArray[np.float32],
    labels: NDArray[np.int32],
    v: int,
    u: int,
    side: NDArray[np.int64],
    returning: tuple[int, int, int, int],
    reach_px: int,
    noise: float,
) -> int:
    """Kind of what lies beyond a border pixel on one side; -1 where the surface goes on."""
    u0, v0, u1, v1 = returning
    lost = same = seen = 0
    z = depth_m[v, u]
    smear = min(SMEAR_PX, reach_px - 1)
    nearest = z
    for k in range(1, reach_px + 1):
        i, j = v + side[1] * k, u + side[0] * k
        if not (v0 <= i < v1 and u0 <= j < u1):
            break
        seen += 1
        lost += depth_m[i, j] <= 0
        same += labels[i, j] == labels[v, u]
        if k > smear and depth_m[i, j] > 0:
            nearest = min(nearest, depth_m[i, j])
    if 2 * same >= reach_px:
        return -1
    if 3 * lost >= 2 * seen:
        return MISSING
    return OCCLUDED if nearest < z - NEARER_M - 3.0 * noise * depth_sigma(z) else REAL


def shares(counts: NDArray[np.int64]) -> Mapping[str, float]:
    """Shares of a border by kind, which sum to 1; empty where none was counted."""
    listed = counts.tolist()
    total = sum(listed)
    return {k: n / total for k, n in zip(KINDS, listed, strict=True)} if total else {}
