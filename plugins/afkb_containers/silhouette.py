"""The outline of a body in the image: how convex it is, handles and spouts aside."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.from_above import hull_candidates
from afkb_mapping.image_regions import extent
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile

HANDLE_M = 0.018
"""What is thinner, a handle, a spout or a stem, is no part of a body's core."""
LEAST_RADIUS_PX = 2.0
"""Near bodies are looked at in every second, third, … row and column, so long as handles show."""
PAD = 2
OWN, UNKNOWN = 1, 2
NEARER_M, NEARER_SIGMAS = 0.02, 4.0


@dataclass(frozen=True, slots=True)
class Silhouette:
    """Shape of a body's image.

    - `solidity`: share of its core's convex hull that the core fills, as far as can be seen.
    - `core_share`: share of the body's pixels that are in its core.
    - `stem_m`: how far the body reaches down below its core.
    """

    solidity: float
    core_share: float
    stem_m: float


def silhouette_of(
    body: Body, depth_m: NDArray[np.float32], focal_px: float, sigma_m: float
) -> Silhouette:
    """Its core is what an opening by half a handle's width leaves, the largest piece of it.

    Pixels that returned nothing, or show something nearer, say nothing about its outline.
    """
    radius = 0.5 * HANDLE_M * focal_px / percentile(body.depth_m, 50.0)
    step = max(1, int(radius / LEAST_RADIUS_PX))
    nearer = percentile(body.depth_m, 2.0) - NEARER_M - NEARER_SIGMAS * sigma_m
    window = _window(body.u, body.v, depth_m, extent(body.u, body.v), step, nearer)
    seen = (window == OWN).astype(np.uint8)
    # most of whose neighbours are the body's is a hole by noise
    own = seen | cv2.medianBlur(seen, 3)
    unknown = (window == UNKNOWN) & (own == 0) & (_hull_of(own) > 0)
    core = _core(own | unknown.astype(np.uint8), radius / step)
    known = (_hull_of(core) > 0) & ~unknown
    in_core = own & core
    return Silhouette(
        solidity=float(np.count_nonzero(core[known])) / max(np.count_nonzero(known), 1),
        core_share=cv2.countNonZero(in_core) / max(cv2.countNonZero(own), 1),
        stem_m=_stem(in_core, body, step),
    )


def _stem(in_core: NDArray[np.uint8], body: Body, step: int) -> float:
    """How far a body reaches down below its core, m."""
    heights, n = _heights_in(in_core, body.u, body.v, body.points, step)
    if n == 0:
        return 0.0
    return percentile(heights[:n], 2.0) - percentile(body.points[:, 2], 2.0)


@kernel
def _heights_in(
    in_core: NDArray[np.uint8],
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    points: NDArray[np.float64],
    step: int,
) -> tuple[NDArray[np.float64], int]:
    """Heights of the body's points whose pixel is in the core, and their number."""
    out, n = np.empty(len(u)), 0
    u0, v0 = u.min() // step, v.min() // step
    for k in range(len(u)):
        if in_core[v[k] // step - v0 + PAD, u[k] // step - u0 + PAD]:
            out[n] = points[k, 2]
            n += 1
    return out, n


def _core(mask: NDArray[np.uint8], radius_px: float) -> NDArray[np.uint8]:
    """The largest piece of a mask opened by a disc; all of it where nothing is left."""
    size = 2 * round(radius_px) + 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, disc)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(opened, connectivity=8)
    if count < 2:
        return mask
    return (labels == 1 + int(stats[1:, cv2.CC_STAT_AREA].argmax())).astype(np.uint8)


def _hull_of(mask: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The convex hull of a mask's pixels, filled."""
    full = np.zeros_like(mask)
    ends = _row_ends(mask)
    if len(ends):
        cv2.fillConvexPoly(full, cv2.convexHull(hull_candidates(ends).astype(np.int32)), 1)
    return full


@kernel
def _window(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    box: tuple[int, int, int, int],
    step: int,
    nearer_m: float,
) -> NDArray[np.uint8]:
    """OWN where a body's pixels are, UNKNOWN where nothing returned or what did is nearer, else 0.

    Cut out with PAD pixels around; a pixel of it is the corner of `step` by `step` of the image.
    """
    u0, v0, u1, v1 = box
    i0, j0 = v0 // step, u0 // step
    rows, cols = (v1 - 1) // step - i0 + 1, (u1 - 1) // step - j0 + 1
    window = np.zeros((rows + 2 * PAD, cols + 2 * PAD), np.uint8)
    for i in range(rows):
        for j in range(cols):
            if depth_m[(i + i0) * step, (j + j0) * step] < nearer_m:
                window[i + PAD, j + PAD] = UNKNOWN
    for k in range(len(u)):
        if u[k] % step == 0 and v[k] % step == 0:
            window[v[k] // step - i0 + PAD, u[k] // step - j0 + PAD] = OWN
    return window


@kernel
def _row_ends(mask: NDArray[np.uint8]) -> NDArray[np.int32]:
    """First and last pixel (u, v) of each row of a mask: (N, 2)."""
    ends = np.empty((2 * mask.shape[0], 2), np.int32)
    n = 0
    for v in range(mask.shape[0]):
        first = last = -1
        for u in range(mask.shape[1]):
            if mask[v, u]:
                first = u if first < 0 else first
                last = u
        if first >= 0:
            ends[n, 0], ends[n, 1], ends[n + 1, 0], ends[n + 1, 1] = first, v, last, v
            n += 2
    return ends[:n]
