"""Support-ability and block-ability grounded in depth: the localizer filtration (paper §II.D.i)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.image_regions import Rectangle, order_by_label, returning_rectangle
from afkb_surfaces.cells import Cells
from afkb_surfaces.describe import KINECT_FOCAL_PX
from afkb_surfaces.fragments import join_fragments
from afkb_surfaces.grouping import (
    UPRIGHT,
    classify,
    links_of,
    renamed,
)
from afkb_surfaces.labelled import Labelled
from afkb_surfaces.levels import Parts, grown_level
from afkb_surfaces.patches import measure_patches
from afkb_surfaces.settings import SurfaceSettings
from afkb_surfaces.supports import LEAST_CELLS, LEAST_PIXELS, Supports, candidates
from afkb_surfaces.upright import CELLS, measure_walls, upright_detections

LEAST_WALL_CELLS = 20
WORTH_A_LOOK = 0.9
"""What is lower than this part of the lowest bound isn't looked at closer."""
UPRIGHT_WITHIN_RAD = math.radians(12)


class SurfaceDetector:
    """Finds floor, supports and upright bounds in a placed view; needs nothing but depth.

    Coarse to fine: planes of small cells, cells grown to surfaces, parts behind an occluder
    joined, borders settled per pixel (`settings.borders`). The floor is reported once, with
    `measures["is_floor"]` and without pixels of its own.
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
        cells = Cells.of(view.depth_m, intrinsics, T, s.softness_m, self._thin(camera.fx))
        tilt = math.radians(s.normal_to_up_deg[3])
        kinds = classify(cells.planes, tilt, UPRIGHT_WITHIN_RAD, s.floor_m, cells.noise)
        links = links_of(cells.planes, kinds, s.step_m, cells.noise)
        labels, of_label, supports = grown_level(cells, kinds, links, s.step_m)
        target = join_fragments(view.depth_m, cells, supports, intrinsics, T, s.step_m, s.gap_m)
        labels = renamed(labels, target)
        returning = returning_rectangle(view.depth_m)
        upward, upright = of_label != UPRIGHT, of_label == UPRIGHT
        every = np.ones(len(of_label), np.bool_)
        every[0] = upward[0] = False
        parts = order_by_label(labels.ravel(), every)
        walls = self._bounds(cells, parts, upright, returning, camera.fx)
        return [*self._supports(view, cells, labels, parts, upward, returning), *walls]

    def _thin(self, focal_px: float) -> int:
        """Every how manieth row and column is enough for cells.

        A cell need not see finer than the surfaces that it looks for; where borders are not
        settled to the pixel, half as finely will do.
        """
        return max(1, round(focal_px / KINECT_FOCAL_PX - 0.15)) * (
            1 if self.settings.borders else 2
        )

    def _supports(
        self,
        view: View,
        cells: Cells,
        labels: NDArray[np.int32],
        parts: Parts,
        upward: NDArray[np.bool_],
        returning: Rectangle,
    ) -> Iterator[Detection]:
        depth, camera, T, s = view.depth_m, view.camera, view.T_map_camera, self.settings
        assert depth is not None and camera is not None
        intrinsics = np.array([camera.fx, camera.fy, camera.cx, camera.cy])
        angle, eye = cells.size_px / camera.fx, float(T[2, 3])
        measures = measure_patches(*parts, upward, cells.planes, LEAST_CELLS, angle, eye)
        least = LEAST_PIXELS * (camera.fx / KINECT_FOCAL_PX) ** 2
        steepest = math.radians(s.normal_to_up_deg[3])
        wanted = candidates(measures, eye, least, s.area_m2[0], steepest)
        image = coarse = Labelled.of_cells(cells, labels, intrinsics, returning)
        if s.borders:
            image = Labelled.of_pixels(
                depth, cells, labels, wanted, intrinsics, returning, s.softness_m
            )
        return Supports(
            depth, cells, measures, wanted, image, coarse, T, camera.fx, s, self.name
        ).detections()

    def _bounds(
        self,
        cells: Cells,
        parts: Parts,
        upright: NDArray[np.bool_],
        returning: Rectangle,
        focal_px: float,
    ) -> Iterator[Detection]:
        tall = WORTH_A_LOOK * self.settings.bound_height_m[0]
        angle = cells.size_px / focal_px
        measures = measure_walls(*parts, upright, cells.planes, LEAST_WALL_CELLS, tall, angle)
        tall_ones = measures[measures[:, CELLS] > 0]
        return upright_detections(tall_ones, cells, returning, self.settings, self.name)
