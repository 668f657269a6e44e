"""What a view's pixels belong to, worked out once for every kind of thing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.depth_points import height_per_depth, intrinsics_of, map_points
from afkb_mapping.kernels import kernel
from afkb_things.above import fit_supports, label_things
from afkb_things.roots import over_roots, roots_of
from afkb_things.settings import ThingSettings
from afkb_things.supports import Supports

THIN = 3
"""Every such row and column of the image says how a support slopes."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A view, labelled.

    - `points`: (H, W, 3) float32, map frame. `labels`: (H, W), see `label_things`.
    - `pools`: (H, W), the same with those supports left out that are the tops of things themselves;
      `overs_m`: (H, W), height of a point over the support of its pool.
    - `intrinsics`: fx, fy, cx, cy. `planes`: (K, 3), see `fit_supports`.
    """

    depth_m: NDArray[np.float32]
    intrinsics: NDArray[np.float64]
    T_map_camera: NDArray[np.float64]
    points: NDArray[np.float32]
    supports: Supports
    planes: NDArray[np.float64]
    labels: NDArray[np.int16]
    pools: NDArray[np.int16]
    overs_m: NDArray[np.float32]

    @property
    def camera_xyz(self) -> NDArray[np.float64]:
        """Where the camera is, map frame."""
        return self.T_map_camera[:3, 3]

    def at(
        self, u: NDArray[np.int32], v: NDArray[np.int32]
    ) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
        """Depths (N,) and points (N, 3), map frame, of pixels."""
        return _taken(u, v, self.depth_m, self.points)

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
        supports = Supports.of(earlier)
        grid = (supports.raster, supports.origin_xy)
        coarse = np.ascontiguousarray(view.depth_m[::THIN, ::THIN])
        sparse = map_points(coarse, intrinsics / THIN, T)
        planes = fit_supports(coarse, sparse, supports.heights_m, *grid)
        slope = height_per_depth(intrinsics, T)
        points, labels, overs = label_things(
            view.depth_m, intrinsics, T, planes, supports.large, *grid, slope, *settings.above_m
        )
        roots = roots_of(
            supports.heights_m, supports.areas_m2, supports.large, supports.raster,
            settings.above_m[1],
        )  # fmt: skip
        pools = over_roots(labels, overs, points, planes, supports.origin_xy, roots)
        return cls(view.depth_m, intrinsics, T, points, supports, planes, labels, pools, overs)


@kernel
def _taken(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    points: NDArray[np.float32],
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    depths, xyz = np.empty(len(u), np.float32), np.empty((len(u), 3))
    for n in range(len(u)):
        depths[n] = depth_m[v[n], u[n]]
        for k in range(3):
            xyz[n, k] = points[v[n], u[n], k]
    return depths, xyz
