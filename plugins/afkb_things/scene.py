"""What a view's pixels belong to, worked out once for every kind of thing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.depth_points import height_per_depth, intrinsics_of, points_at
from afkb_mapping.image_regions import order_by_label
from afkb_mapping.view_noise import noise_scale_of
from afkb_things.above import fit_supports, label_things
from afkb_things.roots import roots_of
from afkb_things.settings import ThingSettings
from afkb_things.supports import Supports

MODEL_WITHIN = 1.25
"""A view is as noisy as the sensor's model says, to within such a factor."""
THIN = 3
"""Every such row and column of the image says how a support slopes."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A view, labelled.

    - `labels`, `overs_m` (H, W), and `standing` (columns, rows, supports): see `label_things`.
    - `intrinsics`: fx, fy, cx, cy. `planes`: (K, 3), see `fit_supports`.
    - `noise`: how many times noisier than the sensor's model the view is.
    - `names`: (H, W), scratch to number bodies in; 0 whenever nobody does.
    """

    depth_m: NDArray[np.float32]
    intrinsics: NDArray[np.float64]
    T_map_camera: NDArray[np.float64]
    supports: Supports
    planes: NDArray[np.float64]
    labels: NDArray[np.int16]
    overs_m: NDArray[np.float32]
    standing: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]
    noise: float
    names: NDArray[np.int32]

    @property
    def camera_xyz(self) -> NDArray[np.float64]:
        """Where the camera is, map frame."""
        return self.T_map_camera[:3, 3]

    def at(
        self, u: NDArray[np.int32], v: NDArray[np.int32]
    ) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
        """Depths (N,) and points (N, 3), map frame, of pixels."""
        return points_at(u, v, self.depth_m, self.intrinsics, self.T_map_camera)

    def on_each_support(
        self, at_least: int
    ) -> Iterator[tuple[int, NDArray[np.int32], NDArray[np.int32]]]:
        """Each support that carries so many pixels, and their columns and rows, by rows."""
        u, v, supports = self.standing
        wanted = np.ones(len(self.planes), np.bool_)
        order, starts = order_by_label(supports, wanted)
        for k in np.flatnonzero(np.diff(starts) >= at_least):
            own = order[starts[k] : starts[k + 1]]
            yield int(k), u[own], v[own]

    def slope_under(self, support: int) -> tuple[float, float, float]:
        """What a support's fitted plane rises above its height per metre of x, of y, and at all."""
        a, b, c = (float(p) for p in self.planes[support])
        x, y = (float(p) for p in self.supports.origin_xy)
        return a, b, c - a * x - b * y - float(self.supports.heights_m[support])

    @classmethod
    def of(cls, view: View, earlier: Sequence[Detection], settings: ThingSettings) -> Scene | None:
        """The labelled view, or None where it has no depth."""
        if view.depth_m is None or view.camera is None:
            return None
        intrinsics, T = intrinsics_of(view), view.T_map_camera
        noise = max(1.0, noise_scale_of(view) / MODEL_WITHIN)
        s = Supports.of(earlier, T[:3, 3].copy(), noise)
        grid = (s.raster, s.origin_xy)
        coarse = np.ascontiguousarray(view.depth_m[::THIN, ::THIN])
        planes = fit_supports(coarse, intrinsics / THIN, T, s.heights_m, *grid)
        roots = roots_of(s.heights_m, s.areas_m2, s.large, s.raster, settings.above_m[1])
        slope = height_per_depth(intrinsics, T)
        labels, overs, *standing = label_things(
            view.depth_m, intrinsics, T, planes, s.large, roots, *grid, slope,
            *settings.above_m, noise,
        )  # fmt: skip
        u, v, on = standing
        names = np.zeros(labels.shape, np.int32)
        return cls(view.depth_m, intrinsics, T, s, planes, labels, overs, (u, v, on), noise, names)
