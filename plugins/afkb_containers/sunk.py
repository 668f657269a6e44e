"""Containers let into a surface: basins and tubs, seen as a hole in their rim's plane."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_containers.judge import LEAST_CLAIM
from afkb_containers.settings import ContainerSettings
from afkb_mapping.bodies import supports_among
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.from_above import box_around, hull_candidates
from afkb_mapping.grid_components import AREA, components
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership

CELL_M = 0.02
LEAST_DEPTH_M = 0.05
EDGE_M = 0.012
"""What is this much lower than the rim belongs to the hole; its deepest part says how deep."""
LEAST_AREA_M2 = 0.03
LEAST_SUPPORT_M2 = 0.02
ABOVE_FLOOR_M = 0.05
RING_CELLS = 4
ON_TOP = 2
RING = (0.60, 0.85)
"""Share of the way around a hole on which there must be rim: none below, fully sure above."""


@kernel
def _holes(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    height_m: float,
    hull: NDArray[np.uint8],
    origin_xy: NDArray[np.float64],
    image_box: tuple[int, int, int, int],
) -> NDArray[np.float32]:
    """Deepest point seen through each square of a plane's hull (X, Y), m; 0 where none is.

    `hull` is 1 inside the hull and ON_TOP where the plane itself is seen.
    Whatever is seen through the hull lies in the image box of its support.
    """
    deepest = np.zeros(hull.shape, np.float32)
    camera_xyz, drop = T_map_camera[:3, 3], T_map_camera[2, 3] - height_m
    p = np.empty(3)
    u0, v0, u1, v1 = image_box
    for v in range(v0, v1):
        for u in range(u0, u1):
            z = depth_m[v, u]
            x, y = (u - intrinsics[2]) / intrinsics[0], (v - intrinsics[3]) / intrinsics[1]
            for k in range(3):
                T = T_map_camera[k]
                p[k] = (T[0] * x + T[1] * y + T[2]) * z + T[3]
            h = p[2]
            under = height_m - h
            if z <= 0 or under < EDGE_M + depth_sigma(z) or h < ABOVE_FLOOR_M:
                continue
            t = drop / (camera_xyz[2] - h)
            dx, dy = p[0] - camera_xyz[0], p[1] - camera_xyz[1]
            i = int((camera_xyz[0] + t * dx - origin_xy[0]) / CELL_M)
            j = int((camera_xyz[1] + t * dy - origin_xy[1]) / CELL_M)
            a = int((p[0] - origin_xy[0]) / CELL_M)
            b = int((p[1] - origin_xy[1]) / CELL_M)
            rows, cols = hull.shape
            if not (0 <= i < rows and 0 <= j < cols and 0 <= a < rows and 0 <= b < cols):
                continue
            if hull[i, j] == 1 and hull[a, b] > 0:
                deepest[i, j] = max(deepest[i, j], under)
    return deepest


def sunk_containers(
    view: View, earlier: Sequence[Detection], settings: ContainerSettings, detector: str
) -> Iterator[Detection]:
    """Hollows in the supports of a view that are deep, wide, and ringed by their support."""
    for support in supports_among(earlier):
        height = float(support.position_xyz[2])
        if view.T_map_camera[2, 3] - height < 0.05 or height < ABOVE_FLOOR_M + LEAST_DEPTH_M:
            continue
        if len(support.footprint_xy) * CELL_M**2 < LEAST_SUPPORT_M2:
            continue
        yield from _in_support(view, support, height, settings, detector)


def _in_support(
    view: View,
    support: Detection,
    height_m: float,
    settings: ContainerSettings,
    detector: str,
) -> Iterator[Detection]:
    origin = support.footprint_xy.min(axis=0) - CELL_M * (RING_CELLS + 2.5)
    ij = np.floor((support.footprint_xy - origin) / CELL_M).astype(np.int32)
    top = np.zeros(tuple((ij.max(axis=0) + RING_CELLS + 3).tolist()), np.uint8)
    top[ij[:, 0], ij[:, 1]] = 1
    hull = np.zeros_like(top)
    cv2.fillConvexPoly(hull, cv2.convexHull(hull_candidates(ij[:, ::-1]).astype(np.int32)), 1)
    hull[(top > 0) & (hull > 0)] = ON_TOP
    assert view.depth_m is not None
    rows, cols = view.depth_m.shape
    box = support.image_box or (0, 0, cols, rows)
    camera = (intrinsics_of(view), view.T_map_camera)
    deepest = _holes(view.depth_m, *camera, height_m, hull, origin, box)
    open_ = cv2.morphologyEx((deepest > 0).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3)))
    parts, measures = components(open_, False)
    for k in range(1, len(measures)):
        if measures[k, AREA] * CELL_M**2 < LEAST_AREA_M2:
            continue
        hole = parts == k
        if percentile(deepest[hole], 95.0) < LEAST_DEPTH_M:
            continue
        ring = _ring_share(hole, top)
        sure = min(1.0, (ring - RING[0]) / (RING[1] - RING[0]))
        if sure > 0:
            found = _detection(
                hole, deepest, origin, height_m, sure, ring, support, settings, detector
            )
            if found.affords("ContainAbility", LEAST_CLAIM):
                yield found


def _ring_share(hole: NDArray[np.bool_], top: NDArray[np.uint8]) -> float:
    """Share of a hole's outline next to which, going outwards, its support is seen."""
    outline = cv2.dilate(hole.astype(np.uint8), np.ones((3, 3))) - hole.astype(np.uint8)
    near = cv2.dilate(top, np.ones((2 * RING_CELLS + 1,) * 2, np.uint8))
    return float((outline & near).sum() / max(int(outline.sum()), 1))


def _detection(
    hole: NDArray[np.bool_],
    deepest: NDArray[np.float32],
    origin: NDArray[np.float64],
    rim_m: float,
    sure: float,
    ring: float,
    support: Detection,
    settings: ContainerSettings,
    detector: str,
) -> Detection:
    footprint = (np.argwhere(hole) + 0.5) * CELL_M + origin
    depth = percentile(deepest[hole & (deepest > 0)], 95.0)
    box = box_around(footprint, rim_m, CELL_M, depth)
    length, width = box.size_xyz[:2]
    sure *= membership(width, settings.basin_width_m)
    sure *= membership(depth / math.sqrt(length * width), settings.depth_over_opening)
    return Detection(
        detector=detector,
        affordances={"ContainAbility": 0.9 * sure},
        box=box,
        position_xyz=np.array(box.center_xyz),
        covariance_xyz=np.diag([4e-4, 4e-4, 4e-4]),
        footprint_xy=footprint,
        n_pixels=int(hole.sum()),
        range_m=support.range_m,
        image_box=support.image_box,
        cut_by_image=support.cut_by_image,
        measures={"rim_height": rim_m, "height": depth, "depth": depth, "rim_share": ring},
    )
