"""A view as bodies are measured in it: near ones in every second, third, … row and column."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.image_regions import Rectangle, is_cut, returning_rectangle
from afkb_mapping.view_noise import noise_scale_of

ENOUGH_PIXELS = 1500
"""So many pixels of a body tell its shape; four times as many are thinned."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """A depth image (H, W), fx, fy, cx, cy (4,) and poses (4, 4) of its camera, map frame.

    `noise_scale`: how many times worse than its model its noise is.
    """

    depth_m: NDArray[np.float32]
    intrinsics: NDArray[np.float64]
    T_map_camera: NDArray[np.float64]
    T_camera_map: NDArray[np.float64]
    noise_scale: float

    @property
    def camera_xyz(self) -> NDArray[np.float64]:
        """Where the camera is, m."""
        return self.T_map_camera[:3, 3]

    @property
    def focal_px(self) -> float:
        """Focal length along rows, pixels."""
        return float(self.intrinsics[0])


class Sights:
    """The sights of one view, each made when it is first asked for."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._made: dict[int, Sight] = {}

    @cached_property
    def _poses(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        T = self._view.T_map_camera
        return T, np.linalg.inv(T).astype(np.float64)

    @cached_property
    def _returning(self) -> Rectangle:
        assert self._view.depth_m is not None
        return returning_rectangle(self._view.depth_m)

    def cuts(self, thing: Detection) -> bool:
        """Whether a thing reaches the edge of what the sensor can return."""
        return thing.image_box is not None and is_cut(thing.image_box, self._returning)

    def every(self, step: int) -> Sight:
        """The view in every such row and column."""
        if step not in self._made:
            assert self._view.depth_m is not None
            depth_m = np.ascontiguousarray(self._view.depth_m[::step, ::step])
            intrinsics = intrinsics_of(self._view) / step
            self._made[step] = Sight(depth_m, intrinsics, *self._poses, noise_scale_of(self._view))
        return self._made[step]


def step_for(n_pixels: int) -> int:
    """Which rows and columns of a body of so many pixels are enough."""
    return max(1, int(math.sqrt(n_pixels / ENOUGH_PIXELS)))
