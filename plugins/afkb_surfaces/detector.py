"""Support-ability and block-ability grounded in depth: the localizer filtration (paper §II.D.i)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from afkb.flow import Detection, View
from numpy.typing import NDArray

from afkb_surfaces.borders import missing_border_fractions
from afkb_surfaces.cells import cell_planes, cell_sums
from afkb_surfaces.describe import (
    Patch,
    filled_footprint,
    mode_height,
    on_grid,
    support_detection,
)
from afkb_surfaces.fragments import join_fragments
from afkb_surfaces.grouping import SUPPORT, UPRIGHT, classify, grow, pixel_labels
from afkb_surfaces.settings import SurfaceSettings
from afkb_surfaces.upright import upright_detection

FLOOR_LABEL = 1
MIN_PIXELS = 80
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
        pixels = pixel_labels(view.depth_m, cells, labels, s.softness_m)
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
        is_support = np.zeros(int(labels.max()) + 1, bool)
        is_support[labels[kinds == SUPPORT]] = True
        is_support[FLOOR_LABEL:2] = True
        missing = missing_border_fractions(depth_m, pixels, len(is_support))
        for label, flat in pixels_by_label(pixels, is_support):
            if len(flat) < MIN_PIXELS:
                continue
            patch = patch_of(flat[:: 9 if label == FLOOR_LABEL else 1], depth_m, intrinsics, T)
            if label == FLOOR_LABEL:
                yield from self._floor(patch, len(flat))
                continue
            height = mode_height(patch.points[:, 2])
            if height > T[2, 3] - BELOW_CAMERA_M:
                continue
            footprint = filled_footprint(
                patch, pixels, label, height, intrinsics, T, self.settings.footprint_step_m
            )
            found = support_detection(
                patch, footprint, height, float(missing[label]), self.settings, self.name
            )
            if found is not None:
                yield found

    def _floor(self, patch: Patch, n_pixels: int) -> Iterator[Detection]:
        footprint = on_grid(patch.points[:, :2], 0.05)
        found = support_detection(patch, footprint, 0.0, 0.0, self.settings, self.name)
        if found is not None:
            yield _as_floor(found, float(np.median(patch.points[:, 2])), n_pixels)

    def _bounds(
        self,
        cells: NDArray[np.float64],
        labels: NDArray[np.int32],
        kinds: NDArray[np.int8],
        focal_px: float,
    ) -> Iterator[Detection]:
        upright = np.where(kinds == UPRIGHT, labels, 0).astype(np.int32)
        for _, flat in pixels_by_label(upright, np.ones(int(labels.max()) + 1, bool)):
            if len(flat) >= MIN_PIXELS // 4:
                rc = np.column_stack(np.divmod(flat, labels.shape[1]))
                found = upright_detection(rc, cells, focal_px, self.settings, self.name)
                if found is not None:
                    yield found


def pixels_by_label(
    labels: NDArray[np.int32], wanted: NDArray[np.bool_]
) -> Iterator[tuple[int, NDArray[np.int64]]]:
    """Each wanted label above 0 with the flat indexes that carry it, in order."""
    flat = np.flatnonzero(wanted[labels.ravel()] & (labels.ravel() > 0))
    of = labels.ravel()[flat]
    order = np.argsort(of, kind="stable")
    flat, of = flat[order], of[order]
    if len(of) == 0:
        return
    names, starts = np.unique(of, return_index=True)
    for name, group in zip(names, np.split(flat, starts[1:]), strict=True):
        yield int(name), group


def patch_of(
    flat: NDArray[np.int64],
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
) -> Patch:
    """The pixels of flat indexes with their points in the map frame."""
    v, u = np.divmod(flat, depth_m.shape[1])
    z = depth_m.ravel()[flat]
    fx, fy, cx, cy = intrinsics
    camera = np.column_stack([(u - cx) / fx * z, (v - cy) / fy * z, z])
    points = camera @ T_map_camera[:3, :3].T + T_map_camera[:3, 3]
    return Patch(u, v, z, points, (depth_m.shape[0], depth_m.shape[1]))


def _as_floor(found: Detection, height_m: float, n_pixels: int) -> Detection:
    """The same, marked as the floor; its height is where it was seen, its top is z = 0."""
    from dataclasses import replace

    measures = {**found.measures, "is_floor": 1.0, "height": height_m}
    return replace(found, n_pixels=n_pixels, extent_known=True, measures=measures)
