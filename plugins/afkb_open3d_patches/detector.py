"""Support-ability and block-ability by Open3D's planar patches: a peer of the `surfaces` detector.

It stands behind the same protocol, so that swapping is a matter of its name, and so that the
benchmark compares like with like. It does not run unless it is named.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_mapping.from_above import box_around, on_grid
from afkb_mapping.image_regions import Rectangle, extent, is_cut, returning_rectangle
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import Limits, membership, parameters
from afkb_open3d_patches.patches import THIN, Patch, planar_patches

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

FLOOR_M = 0.05
STEP_M = 0.02
UPRIGHT_DEG = 12.0
SURE = 0.9
"""A patch that Open3D reports is taken for a surface this surely, its size and tilt aside."""


@dataclass(frozen=True, slots=True, eq=False)
class PlanarPatchDetector:
    """Floor, supports and upright bounds in a placed view; lengths in m, angles in degrees."""

    normal_to_up_deg: Limits = (-1.0, 0.0, 15.0, 30.0)
    area_m2: Limits = (0.015, 0.06, math.inf, math.inf)
    bound_height_m: Limits = (0.6, 1.0, math.inf, math.inf)

    name = "open3d-patches"
    affordances = ("SupportAbility", "BlockAbility")
    stage = 0
    by_default = False

    @classmethod
    def from_knowledge(cls, knowledge_base: AfNet) -> PlanarPatchDetector:
        """With the limits that the features state in the ontology; what they leave out stays."""
        support = parameters(knowledge_base, "SupportAbility")
        block = parameters(knowledge_base, "BlockAbility")
        base = cls()
        return cls(
            support.get("normal_to_up_deg", base.normal_to_up_deg),
            support.get("area_m2", base.area_m2),
            block.get("height_m", base.bound_height_m),
        )

    def detect(self, view: View, earlier: Sequence[Detection] = ()) -> list[Detection]:
        """Supports and bounds in the map frame; none where the view has no depth."""
        if view.depth_m is None or view.camera is None:
            return []
        returning = returning_rectangle(view.depth_m)
        found: list[Detection] = []
        floor: list[Detection] = []
        for patch in planar_patches(view):
            tilt_deg = math.degrees(math.acos(min(max(float(patch.normal[2]), -1.0), 1.0)))
            if abs(tilt_deg - 90.0) <= UPRIGHT_DEG:
                found += self._bound(patch, view, returning)
            elif tilt_deg < self.normal_to_up_deg[3]:
                height = float(np.median(patch.points[:, 2]))
                into = floor if abs(height) <= FLOOR_M else found
                into += self._support(patch, height, tilt_deg, view, returning)
        return [*self._one_floor(floor), *found]

    def _support(
        self, patch: Patch, height: float, tilt_deg: float, view: View, returning: Rectangle
    ) -> Iterator[Detection]:
        footprint = on_grid(patch.points, STEP_M * THIN)
        area = len(footprint) * (STEP_M * THIN) ** 2
        p = membership(min(area, self.area_m2[2]), self.area_m2)
        p *= membership(tilt_deg, self.normal_to_up_deg)
        if p <= 0 or height >= view.T_map_camera[2, 3]:
            return
        box = box_around(footprint, height, STEP_M * THIN)
        sigma = depth_sigma(float(np.median(patch.depth_m)))
        image_box = _image_box(patch, view)
        yield Detection(
            detector=self.name,
            affordances={"SupportAbility": SURE * p},
            box=box,
            position_xyz=np.array([*box.center_xyz[:2], height]),
            covariance_xyz=np.diag([sigma**2 + 1e-4] * 2 + [(0.4 * sigma) ** 2 + 4e-6]),
            footprint_xy=_refined(footprint),
            n_pixels=len(patch.pixels) * THIN**2,
            range_m=float(patch.depth_m.min()),
            image_box=image_box,
            cut_by_image=is_cut(image_box, returning),
            measures={"height": height, "area": area, "tilt_deg": tilt_deg},
            pixels=patch.pixels,
        )

    def _one_floor(self, parts: Sequence[Detection]) -> Iterator[Detection]:
        """The parts of the floor as one detection."""
        if not parts:
            return
        footprint = np.unique(np.vstack([d.footprint_xy for d in parts]), axis=0)
        area = sum(d.measures["area"] for d in parts)
        box = box_around(footprint, 0.0, STEP_M)
        largest = max(parts, key=lambda d: d.n_pixels)
        yield replace(
            largest,
            box=box,
            position_xyz=np.array([*box.center_xyz[:2], 0.0]),
            footprint_xy=footprint,
            n_pixels=sum(d.n_pixels for d in parts),
            range_m=min(d.range_m for d in parts),
            measures={**largest.measures, "is_floor": 1.0, "area": area},
            pixels=None,
        )

    def _bound(self, patch: Patch, view: View, returning: Rectangle) -> Iterator[Detection]:
        low, high = (float(z) for z in np.percentile(patch.points[:, 2], [1, 99]))
        p = membership(high - low, self.bound_height_m)
        if p <= 0:
            return
        middle = patch.points[:, :2].mean(axis=0)
        along = np.array([-patch.normal[1], patch.normal[0]]) / math.hypot(*patch.normal[:2])
        ends = np.percentile((patch.points[:, :2] - middle) @ along, [0.5, 99.5])
        segment = middle + ends[:, None] * along
        length, low = float(ends[1] - ends[0]), max(low, 0.0)
        centre = (float(middle[0]), float(middle[1]), (low + high) / 2)
        variance = depth_sigma(float(np.median(patch.depth_m))) ** 2 + 1e-4
        steps = np.linspace(0, 1, max(2, int(length / STEP_M)))[:, None]
        image_box = _image_box(patch, view)
        yield Detection(
            detector=self.name,
            affordances={"BlockAbility": SURE * p},
            box=OrientedBox(centre, (length, 0.02, high - low), math.atan2(along[1], along[0])),
            position_xyz=np.array(centre),
            covariance_xyz=np.diag([variance, variance, 0.01]),
            footprint_xy=segment[0] * (1 - steps) + segment[1] * steps,
            n_pixels=len(patch.pixels) * THIN**2,
            range_m=float(patch.depth_m.min()),
            image_box=image_box,
            segment_xy=segment,
            cut_by_image=is_cut(image_box, returning),
            measures={"height": high - low, "length": length, "rms": 0.0},
        )


def _image_box(patch: Patch, view: View) -> Rectangle:
    assert view.depth_m is not None
    width = view.depth_m.shape[1]
    u0, v0, u1, v1 = extent(patch.pixels % width, patch.pixels // width)
    return u0, v0, u1 + THIN - 1, v1 + THIN - 1


def _refined(footprint_xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Squares of THIN steps as squares of one, which mapping asks for."""
    offsets = (np.arange(THIN) - (THIN - 1) / 2) * STEP_M
    dx, dy = np.meshgrid(offsets, offsets)
    fine = footprint_xy[:, None] + np.column_stack([dx.ravel(), dy.ravel()])
    result: NDArray[np.float64] = fine.reshape(-1, 2)
    return result
