"""Balls: what affords rolling in any direction, grounded by a sphere in depth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import Detection, OrientedBox, View
from afkb_mapping.geometry import back_project, transform

SMALLEST_M, LARGEST_M = 0.03, 0.5
LEAST_PIXELS = 300
STEP_M = 0.04
"""Neighbouring pixels farther apart than this lie on different things."""


@dataclass(frozen=True, slots=True)
class Sphere:
    """Centre (3,), radius and root mean square distance of the points from it, m."""

    center: NDArray[np.float64]
    radius: float
    residual: float


def fit_sphere(points: NDArray[np.float64]) -> Sphere:
    """The sphere through points (N, 3), N > 3, by linear least squares on |p|² = 2 c·p + k."""
    middle = points.mean(axis=0)
    p = points - middle
    system = np.column_stack([2 * p, np.ones(len(p))])
    (*center, k), *_ = np.linalg.lstsq(system, (p**2).sum(axis=1), rcond=None)
    radius = math.sqrt(max(0.0, k + float(np.dot(center, center))))
    off = np.linalg.norm(p - center, axis=1) - radius
    return Sphere(middle + center, radius, float(np.sqrt(np.mean(off**2))))


@dataclass(frozen=True, slots=True)
class BallDetector:
    """Fits a sphere to each connected piece of depth that stands out from the supports."""

    name: str = "balls"
    affordances: tuple[str, ...] = ("RollAbility3D",)
    stage: int = 1

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        """Balls in view; `earlier` tells the supports, whose own surface is left out."""
        if view.depth_m is None or view.camera is None:
            return []
        points = transform(view.T_map_camera, back_project(view.depth_m, view.camera))
        candidates = _pieces(view.depth_m, _on_support(points, earlier))
        return [d for rows_columns in candidates if (d := self._ball(view, points, rows_columns))]

    def _ball(
        self, view: View, points: NDArray[np.floating], mask: NDArray[np.bool_]
    ) -> Detection | None:
        piece = points[mask].astype(np.float64)
        sphere = fit_sphere(piece)
        range_m = float(np.linalg.norm(sphere.center - view.T_map_camera[:3, 3])) - sphere.radius
        if not SMALLEST_M <= sphere.radius <= LARGEST_M or range_m <= 0:
            return None
        if sphere.residual > _noise(range_m) + 0.02 * sphere.radius or not _round(piece, sphere):
            return None
        return self._detection(view, sphere, mask, range_m)

    def _detection(
        self, view: View, sphere: Sphere, mask: NDArray[np.bool_], range_m: float
    ) -> Detection:
        rows, columns = np.nonzero(mask)
        box = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
        height, width = mask.shape
        x, y, z = (float(v) for v in sphere.center)
        return Detection(
            detector=self.name,
            affordances={"RollAbility3D": 0.99},
            box=OrientedBox((x, y, z), (2 * sphere.radius,) * 3),
            position_xyz=sphere.center,
            covariance_xyz=np.eye(3) * _noise(range_m) ** 2,
            footprint_xy=_disk(sphere),
            n_pixels=len(rows),
            range_m=range_m,
            image_box=tuple(int(v) for v in box),
            cut_by_image=bool(box[0] == 0 or box[1] == 0 or box[2] == width or box[3] == height),
        )


def _noise(range_m: float) -> float:
    """What depth cameras of the Kinect kind err at that range, m (Nguyen et al. 2012)."""
    return 0.003 + 0.0019 * max(0.0, range_m - 0.4) ** 2


def _on_support(points: NDArray[np.floating], earlier: Sequence[Detection]) -> NDArray[np.bool_]:
    """(H, W) whether a point is on the floor or on the top of a support that was found."""
    heights = points[..., 2]
    tops = [d.position_xyz[2] for d in earlier if d.affords("SupportAbility")]
    on = np.zeros(heights.shape, dtype=bool)
    for top in {0.0, *(round(float(t), 3) for t in tops)}:
        on |= np.abs(heights - top) < 0.015
    return on


def _pieces(
    depth_m: NDArray[np.float32], left_out: NDArray[np.bool_]
) -> Iterator[NDArray[np.bool_]]:
    """Connected pieces of the image without jumps in depth, as masks (H, W)."""
    span = ndimage.maximum_filter(depth_m, 3) - ndimage.minimum_filter(depth_m, 3)
    labels, count = ndimage.label((depth_m > 0) & (span < STEP_M) & ~left_out)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    for label in range(1, count + 1):
        if sizes[label] >= LEAST_PIXELS:
            yield labels == label


def _round(piece: NDArray[np.float64], sphere: Sphere) -> bool:
    """Whether enough of the sphere is seen, so that not every small patch passes for one."""
    extent = np.ptp(piece, axis=0)
    return float(np.sort(extent)[1]) > 1.3 * sphere.radius and bool(
        (extent < 2.2 * sphere.radius).all()
    )


def _disk(sphere: Sphere) -> NDArray[np.float64]:
    """(N, 2) points of the sphere seen from above, 0.02 m apart."""
    line = np.arange(-sphere.radius, sphere.radius + 0.01, 0.02)
    x, y = (a.ravel() for a in np.meshgrid(line, line))
    inside = np.hypot(x, y) <= sphere.radius
    disk: NDArray[np.float64] = sphere.center[:2] + np.column_stack([x, y])[inside]
    return disk
