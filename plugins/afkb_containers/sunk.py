"""Containers let into a surface: basins and tubs, seen as a hole in their rim's plane."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_containers.describe import LITRES_PER_M3
from afkb_containers.looks import LEAST_CLAIM
from afkb_containers.rims import CELL_M, Rim, rims_among
from afkb_containers.ring import RIM_CELLS, ring_around
from afkb_containers.settings import ContainerSettings
from afkb_mapping.bodies import supports_among
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.from_above import box_around, hull_candidates
from afkb_mapping.grid.components import AREA, components
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentile
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership, ramp

LEAST_DEPTH_M = 0.05
EDGE_M = 0.012
"""What is this much lower than the rim belongs to the hole; its deepest part says how deep."""
LEAST_AREA_M2 = 0.03
LEAST_SHOWN = 0.5
"""Share of the squares of a hole that show it at least; the others lie between its pixels."""
LEAST_SUPPORT_M2 = 0.02
ABOVE_FLOOR_M = 0.05
UNDERCUT_CELLS = 2
"""How far the wall of a basin reaches under its rim; further in, it is the room below a top."""
MOST_SURE = 0.9
RING = (0.55, 0.75)
"""Share of what is seen around a hole that must be rim: none below, fully sure above."""
SHOWN = (0.35, 0.60)
"""Share of the way around it that must be seen: of a tub that the image edge cuts, half is."""


@kernel
def _holes(
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    height_m: float,
    gap: NDArray[np.uint8],
    reach: NDArray[np.uint8],
    origin_xy: NDArray[np.float64],
    image_box: tuple[int, int, int, int],
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Deepest point seen through each square of a gap in a plane (X, Y), m; pixels that show it.

    `gap` is 1 where, within its hull, the plane isn't seen; what is seen through it must lie below
    `reach`. It all lies in the image box of the plane.
    """
    deepest, counts = np.zeros(gap.shape, np.float32), np.zeros(gap.shape, np.int32)
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
            rows, cols = gap.shape
            if not (0 <= i < rows and 0 <= j < cols and 0 <= a < rows and 0 <= b < cols):
                continue
            if gap[i, j] and reach[a, b]:
                deepest[i, j] = max(deepest[i, j], under)
                counts[i, j] += 1
    return deepest, counts


def sunk_containers(
    view: View, earlier: Sequence[Detection], settings: ContainerSettings, detector: str
) -> Iterator[Detection]:
    """Hollows in the supports of a view that are deep, wide, and ringed by their support."""
    for rim in rims_among(supports_among(earlier)):
        if view.T_map_camera[2, 3] - rim.height_m < LEAST_DEPTH_M:
            continue
        if rim.height_m > ABOVE_FLOOR_M + LEAST_DEPTH_M and rim.area_m2 >= LEAST_SUPPORT_M2:
            yield from _in_rim(view, rim, settings, detector)


def _in_rim(
    view: View, rim: Rim, settings: ContainerSettings, detector: str
) -> Iterator[Detection]:
    corners = cv2.convexHull(hull_candidates(rim.footprint_xy))
    if _most_open_m2(rim, corners) < LEAST_AREA_M2:
        return
    top, hull, origin = _seen_from_above(rim, corners)
    assert view.depth_m is not None
    camera = (intrinsics_of(view), view.T_map_camera)
    deepest, counts = _holes(
        view.depth_m, *camera, rim.height_m, *hull, origin, rim.image_box or _all_of(view)
    )
    if np.count_nonzero(counts) * CELL_M**2 < LEAST_SHOWN * LEAST_AREA_M2:
        return
    open_ = cv2.morphologyEx((deepest > 0).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3)))
    parts, measures = components(open_, False)
    for k in range(1, len(measures)):
        if measures[k, AREA] * CELL_M**2 < LEAST_AREA_M2:
            continue
        cells = parts == k
        depth = percentile(deepest[cells & (deepest > 0)], 95.0)
        if depth < LEAST_DEPTH_M:
            continue
        ring, shown = ring_around(cells, top, CELL_M, origin, rim.height_m, view)
        footprint = (np.argwhere(cells) + 0.5) * CELL_M + origin
        hole = _Hole(footprint, rim, depth, ring, shown, int(counts[cells].sum()))
        score = _score(hole, settings)
        if score >= LEAST_CLAIM:
            yield _detection(hole, score, detector)


def _all_of(view: View) -> tuple[int, int, int, int]:
    assert view.depth_m is not None
    rows, cols = view.depth_m.shape
    return 0, 0, cols, rows


def _most_open_m2(rim: Rim, corners: NDArray[np.float32]) -> float:
    """How much of what its corners (N, 1, 2) enclose may be a hole, with squares on the border."""
    border = cv2.arcLength(corners, True)
    return cv2.contourArea(corners) + border * CELL_M - rim.area_m2


def _seen_from_above(
    rim: Rim, corners: NDArray[np.float32]
) -> tuple[NDArray[np.uint8], tuple[NDArray[np.uint8], NDArray[np.uint8]], NDArray[np.float64]]:
    """Squares (X, Y) where a rim is seen; the gap and reach of `_holes`; and their corner (m).

    `corners` (N, 1, 2) of its hull, m.
    """
    origin = rim.footprint_xy.min(axis=0) - CELL_M * (RIM_CELLS + 2.5)
    ij = np.floor((rim.footprint_xy - origin) / CELL_M).astype(np.int32)
    top = np.zeros(tuple((ij.max(axis=0) + RIM_CELLS + 3).tolist()), np.uint8)
    top[ij[:, 0], ij[:, 1]] = 1
    hull = np.zeros_like(top)
    cv2.fillConvexPoly(hull, np.floor((corners - origin) / CELL_M).astype(np.int32)[..., ::-1], 1)
    gap = hull & (1 - top)
    return top, (gap, cv2.dilate(gap, np.ones((2 * UNDERCUT_CELLS + 1,) * 2, np.uint8))), origin


@dataclass(frozen=True, slots=True, eq=False)
class _Hole:
    """A hole in a rim: its squares (N, 2), how deep it is (m), and what `ring_around` says."""

    footprint_xy: NDArray[np.float64]
    rim: Rim
    depth_m: float
    ring: float
    shown: float
    n_pixels: int

    @property
    def area_m2(self) -> float:
        """How much of it is seen, from above."""
        return len(self.footprint_xy) * CELL_M**2

    @property
    def box(self) -> OrientedBox:
        """From its bottom to its rim."""
        return box_around(self.footprint_xy, self.rim.height_m, CELL_M, self.depth_m)


def _score(hole: _Hole, settings: ContainerSettings) -> float:
    """How surely a hole is a basin: ringed, wide, and deep in itself or for its width."""
    length, width = hole.box.size_xyz[:2]
    deep = max(
        membership(hole.depth_m / math.sqrt(length * width), settings.depth_over_opening),
        membership(hole.depth_m, settings.basin_depth_m),
    )
    ringed = ramp(hole.ring, RING) * ramp(hole.shown, SHOWN)
    return MOST_SURE * ringed * deep * membership(width, settings.basin_width_m)


def _detection(hole: _Hole, score: float, detector: str) -> Detection:
    return Detection(
        detector=detector,
        affordances={"ContainAbility": score},
        box=hole.box,
        position_xyz=np.array(hole.box.center_xyz),
        covariance_xyz=np.diag([4e-4, 4e-4, 4e-4]),
        footprint_xy=hole.footprint_xy,
        n_pixels=hole.n_pixels,
        range_m=hole.rim.range_m,
        image_box=hole.rim.image_box,
        cut_by_image=hole.rim.cut_by_image,
        measures={
            "rim_height": hole.rim.height_m,
            "height": hole.depth_m,
            "depth": hole.depth_m,
            "rim_share": hole.ring,
            "rim_shown": hole.shown,
            "opening_width": math.sqrt(hole.area_m2),
            "volume": LITRES_PER_M3 * hole.area_m2 * hole.depth_m,
        },
    )
