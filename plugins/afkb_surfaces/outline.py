"""The outline of a surface as the image shows it, laid onto the surface: a polygon with holes."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.image_regions import Rectangle
from afkb_mapping.kernels import kernel
from afkb_surfaces.labelled import Labelled

SMALLEST_HOLE_M2 = 0.004
"""A hole smaller than a fist is not told of; glossy spots and speckle make many."""
SIMPLER_PX = 1.0
"""The outline is simplified by at most this much."""
SPECKLE_PX = 3
GAP_SAMPLES = 32
"""Pixels of a gap that are looked at; more would tell no more."""
STANDS_M = 0.01
"""What rises this much over a surface stands on it or before it: what it hides is
no hole."""


def rings_of(
    image: Labelled,
    runs: NDArray[np.int32],
    box: Rectangle,
    plane: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
) -> tuple[NDArray[np.float64], ...]:
    """Outer ring, then holes, each (N, 2), open, m; empty where too little is seen for a ring.

    `runs` (n, 3): the surface's pixels in the image (see `runs_by_label`); `box` (u0, v0, u1, v1)
    holds them; `plane` (3,), z = p0 x + p1 y + p2. What stands on or before the surface is
    bridged. Of parts that nothing bridges the largest is told.
    """
    mask = bridged(runs, box, image.depth_m, plane, image.intrinsics, T_map_camera)
    outlines, family = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_SIMPLE)
    if not outlines:
        return ()
    parents, areas = family[0, :, 3].tolist(), [cv2.contourArea(o) for o in outlines]
    largest = max((k for k, p in enumerate(parents) if p < 0), key=areas.__getitem__)
    camera = (image.intrinsics, T_map_camera)
    ring = _ring(outlines[largest], box, plane, *camera)
    if len(ring) < 3 or areas[largest] < 1:
        return ()
    # a far hole covers more to the pixel than the whole does, a near one less: hence the half
    least = 0.5 * SMALLEST_HOLE_M2 * areas[largest] / max(ring_area(ring), SMALLEST_HOLE_M2)
    large = (k for k, p in enumerate(parents) if p == largest and areas[k] >= least)
    rings = (_ring(outlines[k], box, plane, *camera) for k in large)
    return (ring, *(r for r in rings if ring_area(r) >= SMALLEST_HOLE_M2))


def _ring(
    outline: NDArray[np.int32],
    box: Rectangle,
    plane: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
) -> NDArray[np.float64]:
    """An outline in the pixels of a box, simplified and laid onto the plane: (N, 2), m."""
    ring = cv2.approxPolyDP(outline, SIMPLER_PX, closed=True)[:, 0]
    return on_plane(ring, box[0], box[1], plane, intrinsics, T_map_camera)


@kernel
def bridged(
    runs: NDArray[np.int32],
    box: tuple[int, int, int, int],
    depth_m: NDArray[np.float32],
    plane: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
) -> NDArray[np.uint8]:
    """Mask of pixels in a box, in which gaps along rows that something rising hides are closed.

    Gaps of a few pixels are speckle, and are closed as well.
    """
    u0, v0, u1, v1 = box
    mask = np.zeros((v1 - v0, u1 - u0), np.uint8)
    for n in range(len(runs)):
        v, first, end = runs[n]
        if n > 0 and runs[n - 1, 0] == v:
            before = runs[n - 1, 2]
            if _hides(depth_m[v], before, first, v, plane, intrinsics, T):
                first = before
        mask[v - v0, first - u0 : end - u0] = 1
    return mask


@kernel
def _hides(
    row: NDArray[np.float32],
    start: int,
    end: int,
    v: int,
    plane: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
) -> bool:
    """Whether what a row shows from start to end is speckle, or rises over the plane."""
    if end - start <= SPECKLE_PX:
        return True
    hiding = looked = 0
    for k in range(start, end, 1 + (end - start) // GAP_SAMPLES):
        hiding += _rises(row[k], k, v, plane, intrinsics, T)
        looked += 1
    return 4 * hiding >= 3 * looked


@kernel
def _rises(
    z: float,
    u: int,
    v: int,
    plane: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
) -> bool:
    """Whether what a pixel shows lies over a plane."""
    if not z > 0:
        return False
    a, b = (u - intrinsics[2]) / intrinsics[0], (v - intrinsics[3]) / intrinsics[1]
    x = T[0, 3] + z * (T[0, 0] * a + T[0, 1] * b + T[0, 2])
    y = T[1, 3] + z * (T[1, 0] * a + T[1, 1] * b + T[1, 2])
    over = T[2, 3] + z * (T[2, 0] * a + T[2, 1] * b + T[2, 2])
    return bool(over > plane[0] * x + plane[1] * y + plane[2] + STANDS_M)


@kernel
def on_plane(
    pixels: NDArray[np.int32],
    u0: int,
    v0: int,
    plane: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    T: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Where the rays of pixels (N, 2), counted from (u0, v0), meet the plane: (N, 2), map, m."""
    fx, fy, cx, cy = intrinsics
    out = np.empty((len(pixels), 2))
    below = plane[0] * T[0, 3] + plane[1] * T[1, 3] + plane[2] - T[2, 3]
    for n in range(len(pixels)):
        a, b = (pixels[n, 0] + u0 - cx) / fx, (pixels[n, 1] + v0 - cy) / fy
        x = T[0, 0] * a + T[0, 1] * b + T[0, 2]
        y = T[1, 0] * a + T[1, 1] * b + T[1, 2]
        z = T[2, 0] * a + T[2, 1] * b + T[2, 2]
        along = below / (z - plane[0] * x - plane[1] * y)
        out[n, 0], out[n, 1] = T[0, 3] + along * x, T[1, 3] + along * y
    return out


@kernel
def ring_area(xy: NDArray[np.float64]) -> float:
    """Area of an open ring (N, 2), m²."""
    total = 0.0
    for n in range(len(xy)):
        total += xy[n - 1, 0] * xy[n, 1] - xy[n, 0] * xy[n - 1, 1]
    return 0.5 * abs(total)
