"""Support-ability and block-ability grounded in depth: the localizer filtration (paper §II.D.i)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.from_above import on_grid
from afkb_mapping.image_regions import Region, pixels_by_label
from afkb_mapping.order_statistics import percentile
from afkb_surfaces.borders import missing_border_fractions
from afkb_surfaces.cells import cell_planes, cell_sums
from afkb_surfaces.describe import support_detection
from afkb_surfaces.extents import filled_footprint, mode_height
from afkb_surfaces.fragments import join_fragments
from afkb_surfaces.grouping import (
    SUPPORT,
    UPRIGHT,
    classify,
    grow,
    label_spans,
    pixel_labels,
    points_of,
)
from afkb_surfaces.settings import SurfaceSettings
from afkb_surfaces.upright import upright_detection

FLOOR_LABEL = 1
FLOOR_THIN = 3
FLOOR_STEP_M = 0.05
MIN_PIXELS, MIN_CELLS = 80, 20
BELOW_CAMERA_M = 0.01
"""An upper surface is seen from above only; what seems to be one higher up is noise."""
UPRIGHT_WITHIN_RAD = math.radians(12)


class SurfaceDetector:
    """Finds floor, supports and upright bounds in a placed view; needs nothing but depth.

    Coarse to fine: planes of 4 px cells, cells grown to surfaces, parts behind an occluder
    joined, borders settled per pixel. The floor is reported once, with `measures["is_floor"]`.
    """

    name = "surfaces"
    affordances = ("SupportAbility", "BlockAbility")
    stage = 0

    def __init__(self, settings: SurfaceSettings | None = None) -> None:
        self.settings = settings or SurfaceSettings()

    def detect(self, view: View, earlier: Sequence[Detection] = ()) -> list[Detection]:
        """Supports, then bounds, each in the map frame; none where the view has no depth."""
        if view.depth_m is None or view.camera is None:
            return []
        s, camera, T = self.settings, view.camera, view.T_map_camera
        intrinsics = np.array([camera.fx, camera.fy, camera.cx, camera.cy])
        cells = cell_planes(cell_sums(view.depth_m), intrinsics, T, s.softness_m)
        tilt = math.radians(s.normal_to_up_deg[3])
        kinds = classify(cells, tilt, UPRIGHT_WITHIN_RAD, s.floor_m)
        labels, _ = grow(cells, kinds, s.step_m)
        labels = join_fragments(
            view.depth_m, cells, labels, kinds, intrinsics, T, s.step_m, s.gap_m
        )
        pixels = pixel_labels(view.depth_m, cells, labels, kinds, s.softness_m)
        found = list(self._supports(view.depth_m, labels, kinds, pixels, intrinsics, T))
        return found + list(self._bounds(cells, labels, kinds, camera.fx))

    def _supports(
        self,
        depth_m: NDArray[np.float32],
        labels: NDArray[np.int32],
        kinds: NDArray[np.int8],
        pixels: NDArray[np.int32],
        intrinsics: NDArray[np.float64],
        T: NDArray[np.float64],
    ) -> Iterator[Detection]:
        n = int(labels.max()) + 2
        wanted, thin = np.zeros(n, bool), np.ones(n, np.int64)
        wanted[labels[kinds == SUPPORT]] = True
        wanted[FLOOR_LABEL], thin[FLOOR_LABEL] = True, FLOOR_THIN
        u, v, starts = pixels_by_label(pixels, wanted, thin)
        depths, points = points_of(u, v, depth_m, intrinsics, T)
        missing = missing_border_fractions(depth_m, pixels, n)
        for label in np.flatnonzero(np.diff(starts) >= MIN_PIXELS):
            part = slice(int(starts[label]), int(starts[label + 1]))
            patch = Region(u[part], v[part], depths[part], points[part], depth_m.shape)
            if label == FLOOR_LABEL:
                yield from self._floor(patch)
            else:
                yield from self._support(
                    patch, pixels, int(label), float(missing[label]), intrinsics, T
                )

    def _support(
        self,
        patch: Region,
        pixels: NDArray[np.int32],
        label: int,
        missing_border: float,
        intrinsics: NDArray[np.float64],
        T: NDArray[np.float64],
    ) -> Iterator[Detection]:
        height = mode_height(patch.points)
        if height > T[2, 3] - BELOW_CAMERA_M:
            return
        footprint = filled_footprint(
            patch.points, pixels, label, height, intrinsics, T, self.settings.footprint_step_m
        )
        found = support_detection(
            patch, footprint, height, missing_border, self.settings, self.name
        )
        if found is not None:
            yield found

    def _floor(self, patch: Region) -> Iterator[Detection]:
        """The floor, once; its height is where it was seen, its top is z = 0."""
        footprint = on_grid(patch.points, FLOOR_STEP_M)
        found = support_detection(patch, footprint, 0.0, 0.0, self.settings, self.name)
        if found is not None:
            measures = {
                **found.measures,
                "is_floor": 1.0,
                "area": len(footprint) * FLOOR_STEP_M**2,
                "height": percentile(patch.points[:, 2], 50.0),
            }
            n_pixels = found.n_pixels * FLOOR_THIN**2
            yield replace(found, n_pixels=n_pixels, extent_known=True, measures=measures)

    def _bounds(
        self,
        cells: NDArray[np.float64],
        labels: NDArray[np.int32],
        kinds: NDArray[np.int8],
        focal_px: float,
    ) -> Iterator[Detection]:
        upright = np.where(kinds == UPRIGHT, labels, 0).astype(np.int32)
        n = int(labels.max()) + 1
        spans = label_spans(cells, upright, n)
        tall = spans[:, 2] - spans[:, 1] > 0.9 * self.settings.bound_height_m[0]
        wanted = tall & (spans[:, 0] >= MIN_CELLS)
        wanted[0] = False
        u, v, starts = pixels_by_label(upright, wanted, np.ones(n, np.int64))
        for label in np.flatnonzero(wanted):
            part = slice(int(starts[label]), int(starts[label + 1]))
            found = upright_detection(u[part], v[part], cells, focal_px, self.settings, self.name)
            if found is not None:
                yield found
