"""Supports of a labelled view: which patches are surfaces, and what is told of each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.image_regions import Rectangle, is_cut
from afkb_mapping.kernels import kernel
from afkb_surfaces.borders import REACH_PX, count_borders, shares
from afkb_surfaces.cells import Cells
from afkb_surfaces.describe import (
    KINECT_FOCAL_PX,
    LEVEL_DEG,
    support_detection,
    support_probability,
)
from afkb_surfaces.extents import footprint_of
from afkb_surfaces.grouping import FLOOR_LABEL
from afkb_surfaces.labelled import Labelled, members_of, pixels_of, runs_by_label
from afkb_surfaces.outline import rings_of
from afkb_surfaces.patches import (
    AREA,
    C0,
    CELLS,
    HEIGHT,
    LENGTH,
    MEDIAN,
    MIDDLE_X,
    MIDDLE_Y,
    MIDDLE_Z,
    PIXELS,
    R1,
    SLOPE_X,
    SLOPE_Y,
    TILT,
    X0,
    X1,
    Y0,
    Y1,
)
from afkb_surfaces.settings import SurfaceSettings

FLOOR_STEP_M = 0.05
MARGIN_M = 0.04
LEAST_CELLS, LEAST_PIXELS, LEAST_FLOOR_PIXELS = 3, 80, 700
"""A patch of fewer is noise, however near it is; pixels as a Kinect has them."""
GROWN = 3.0
"""A patch may have up to so many times the pixels, and the area, of its cells."""
BELOW_CAMERA_M = 0.01
"""An upper surface is seen from above only; what seems to be one higher up is noise."""


@kernel
def candidates(
    measures: NDArray[np.float64],
    eye_m: float,
    least_pixels: float,
    least_area_m2: float,
    steepest_rad: float,
) -> NDArray[np.bool_]:
    """Which patches (n_labels,) are worth a closer look, from their measures; never the floor.

    Those under the camera, at eye_m, not too steep, and large enough if they grow.
    """
    chosen = np.zeros(len(measures), np.bool_)
    for k in range(FLOOR_LABEL + 1, len(measures)):
        m = measures[k]
        chosen[k] = (
            m[CELLS] > 0
            and m[HEIGHT] <= eye_m - BELOW_CAMERA_M
            and GROWN * m[AREA] > least_area_m2
            and GROWN * m[PIXELS] >= least_pixels
            and m[TILT] < steepest_rad
        )
    return chosen


@dataclass(frozen=True, slots=True, eq=False)
class Supports:
    """What the supports of one view are told from.

    `image`: labels at the resolution that borders are told at; `coarse`: at that of cells.
    `measures` (n_labels, …): see `patches`; `wanted` (n_labels,): those worth a closer look.
    """

    depth_m: NDArray[np.float32]
    cells: Cells
    measures: NDArray[np.float64]
    wanted: NDArray[np.bool_]
    image: Labelled
    coarse: Labelled
    T_map_camera: NDArray[np.float64]
    focal_px: float
    settings: SurfaceSettings
    detector: str

    def detections(self) -> Iterator[Detection]:
        """The floor first, if it is seen, then the supports in the order of the image."""
        if self.measures[FLOOR_LABEL, PIXELS] >= LEAST_FLOOR_PIXELS * self._fineness**2:
            yield from self._floor(self.measures[FLOOR_LABEL].tolist())
        image, borders = self.image, self._borders(self.image)
        runs, starts = runs_by_label(image.labels, image.near, image.cell, self.wanted)
        for label in np.flatnonzero(self.wanted & (starts[1:] > starts[:-1])).tolist():
            own = runs[starts[label] : starts[label + 1]]
            yield from self._support(label, self.measures[label].tolist(), own, borders[label])

    def _borders(self, image: Labelled) -> NDArray[np.int64]:
        reach = round(REACH_PX * self._fineness) if image.size_px == 1 else 1
        return count_borders(
            image.depth_m,
            image.labels,
            image.border,
            image.cell,
            image.returning,
            self.wanted,
            max(reach, 1),
            self.cells.noise,
        )

    @property
    def _fineness(self) -> float:
        """How many times finer than a Kinect's the image is."""
        return self.focal_px / KINECT_FOCAL_PX

    def _support(
        self, label: int, m: list[float], runs: NDArray[np.int32], border: NDArray[np.int64]
    ) -> Iterator[Detection]:
        image, size = self.image, self.cells.size_px
        members, box = members_of(runs, image.labels.shape[1])
        pixels, image_box = members, self._in_pixels(box)
        if image.size_px > 1:
            pixels = pixels_of(members, image.labels.shape[1], image.size_px, self.depth_m)
        if len(pixels) < LEAST_PIXELS * self._fineness**2:
            return
        tilt_deg = math.degrees(m[TILT])
        band = len(pixels) / (m[LENGTH] * size) / self._fineness
        if support_probability(math.inf, tilt_deg, band, self.settings) <= 0:
            return
        step, plane = self.settings.footprint_step_m, plane_of(m)
        footprint = self._footprint(label, m, plane, step, image)
        area = len(footprint) * step**2
        p = support_probability(area, tilt_deg, band, self.settings)
        if p <= 0:
            return
        yield support_detection(
            p,
            m,
            m[HEIGHT],
            footprint,
            shares(border),
            {"area": area, "band_px": band, "pixels": len(pixels)},
            image_box,
            pixels,
            rings_of(image, runs, box, plane, self.T_map_camera),
            is_cut(image_box, self.image_returning),
            self.cells.noise,
            step,
            self.detector,
        )

    @property
    def image_returning(self) -> tuple[int, int, int, int]:
        """The part of the depth image that `image` covers and that the sensor can return, px."""
        return self._in_pixels(self.image.returning)

    def _in_pixels(self, box: Rectangle) -> Rectangle:
        """A box of `image` in pixels of the depth image."""
        u0, v0, u1, v1 = box
        size = self.image.size_px
        return u0 * size, v0 * size, u1 * size, v1 * size

    def _footprint(
        self,
        label: int,
        m: list[float],
        plane: NDArray[np.float64],
        step: float,
        image: Labelled,
    ) -> NDArray[np.float64]:
        around = MARGIN_M + 2 * self.cells.size_px / self.focal_px * m[MEDIAN]
        span = (m[X0] - around, m[X1] + around, m[Y0] - around, m[Y1] + around)
        return footprint_of(
            image.labels,
            label,
            span,
            plane,
            image.intrinsics,
            self.T_map_camera,
            step,
            image.depth_m,
            self.coarse.labels,
        )

    def _floor(self, m: list[float]) -> Iterator[Detection]:
        """The floor, once; its height is where it was seen, its top is z = 0.

        It has no outline: what is seen of it is bounded by what stands on it.
        """
        plane, size = np.array([0.0, 0.0, m[HEIGHT]]), self.cells.size_px
        footprint = self._footprint(FLOOR_LABEL, m, plane, FLOOR_STEP_M, self.coarse)
        area = len(footprint) * FLOOR_STEP_M**2
        band = m[PIXELS] / (m[LENGTH] * size) / self._fineness
        p = support_probability(area, math.degrees(m[TILT]), band, self.settings)
        if p <= 0:
            return
        c0, c1, r0, r1 = (int(k) for k in m[C0 : R1 + 1])
        image_box = (c0 * size, r0 * size, (c1 + 1) * size, (r1 + 1) * size)
        yield support_detection(
            p,
            m,
            0.0,
            footprint,
            {},
            {"area": area, "band_px": band, "pixels": m[PIXELS], "is_floor": 1.0},
            image_box,
            None,
            (),
            is_cut(image_box, self.image_returning),
            self.cells.noise,
            FLOOR_STEP_M,
            self.detector,
        )


def plane_of(m: list[float]) -> NDArray[np.float64]:
    """Coefficients (3,) of z = p0 x + p1 y + p2: a patch's plane, its height where it is level."""
    if math.degrees(m[TILT]) < LEVEL_DEG[2]:
        return np.array([0.0, 0.0, m[HEIGHT]])
    at_origin = m[MIDDLE_Z] - m[SLOPE_X] * m[MIDDLE_X] - m[SLOPE_Y] * m[MIDDLE_Y]
    return np.array([m[SLOPE_X], m[SLOPE_Y], at_origin])
