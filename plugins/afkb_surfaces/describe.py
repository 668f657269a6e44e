"""From a labelled surface to the `Detection` that speaks of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox
from afkb_surfaces.noise import depth_sigma
from afkb_surfaces.settings import SurfaceSettings, membership

BAND_PX = (6.0, 16.0, math.inf, math.inf)
LEVEL_DEG = (-1.0, 0.0, 5.0, 10.0)
"""A band narrower than BAND_PX is a surface only if it is level: where a thing stands before a
wall, the sensor draws a ramp from its upper edge to the wall."""
SMEAR_PX, SMEARED = (4.0, 9.0, math.inf, math.inf), 0.4
"""The sensor smears an edge over about four pixels: a level band that narrow is doubtful still."""
LOST_BORDER, STRIP_PX = 0.3, 30.0
"""A strip in the image that for this part of its border ends where the sensor returns nothing, as
glossy and black tops do, may reach anywhere; of a broad patch at least what was seen is known."""
THICKNESS_M = 0.02
"""Depth given to the box of a surface whose underside isn't seen."""


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """Pixels of one surface: coordinates, depth (m), and points in the map frame, all (N, …)."""

    u: NDArray[np.int64]
    v: NDArray[np.int64]
    depth_m: NDArray[np.float32]
    points: NDArray[np.float64]
    shape: tuple[int, ...]

    @property
    def image_box(self) -> tuple[int, int, int, int]:
        """Half-open (u0, v0, u1, v1)."""
        return int(self.u.min()), int(self.v.min()), int(self.u.max()) + 1, int(self.v.max()) + 1

    @property
    def cut_by_image(self) -> bool:
        """Whether it reaches the image edge."""
        u0, v0, u1, v1 = self.image_box
        return u0 <= 1 or v0 <= 1 or u1 >= self.shape[1] - 1 or v1 >= self.shape[0] - 1


def mode_height(heights_m: NDArray[np.float64], bin_m: float = 0.004) -> float:
    """Height at which most of a surface lies: mean of what is around the fullest bin, m."""
    low = float(heights_m.min())
    bins = ((heights_m - low) / bin_m).astype(np.int64)
    counts = np.bincount(bins)
    smooth = np.convolve(counts, np.ones(3), mode="same")
    centre = low + (int(smooth.argmax()) + 0.5) * bin_m
    near = np.abs(heights_m - centre) <= 2.5 * bin_m
    return float(heights_m[near].mean())


def on_grid(xy: NDArray[np.float64], step_m: float) -> NDArray[np.float64]:
    """Centres of the grid squares that hold points: (M, 2), sorted, step_m apart."""
    ij = np.floor(xy / step_m).astype(np.int64)
    low = ij.min(axis=0)
    span = ij.max(axis=0) - low + 1
    flat = np.zeros(int(span[0] * span[1]), bool)
    flat[(ij[:, 0] - low[0]) * span[1] + ij[:, 1] - low[1]] = True
    index = np.flatnonzero(flat)
    cells = np.column_stack([index // span[1], index % span[1]]) + low
    return (cells + 0.5) * step_m


def box_around(
    footprint_xy: NDArray[np.float64], top_m: float, step_m: float, height_m: float = THICKNESS_M
) -> OrientedBox:
    """Smallest upright box over a footprint of grid squares, its long side along x."""
    (x, y), (length, width), degrees = cv2.minAreaRect(footprint_xy.astype(np.float32))
    yaw = math.radians(degrees)
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    yaw = (yaw + math.pi / 2) % math.pi - math.pi / 2
    size = (float(length) + step_m, float(width) + step_m, height_m)
    return OrientedBox((float(x), float(y), top_m - height_m / 2), size, yaw)


def filled_footprint(
    patch: Patch,
    labels: NDArray[np.int32],
    label: int,
    height_m: float,
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    step_m: float,
) -> NDArray[np.float64]:
    """Grid squares of a surface: those its pixels fall in, and those that project onto it.

    Rows of a distant, grazing surface fall several squares apart; projecting the squares into
    the image fills what lies between them.
    """
    seen = on_grid(patch.points[:, :2], step_m)
    low, high = seen.min(axis=0), seen.max(axis=0)
    shape = np.round((high - low) / step_m).astype(int) + 1
    if shape[0] * shape[1] > 250_000:
        return seen
    x, y = (low[k] + step_m * np.arange(shape[k]) for k in (0, 1))
    R, t = T_map_camera[:3, :3], T_map_camera[:3, 3]
    dx, dy, dz = x[:, None] - t[0], y[None, :] - t[1], height_m - t[2]
    cam = [R[0, k] * dx + R[1, k] * dy + R[2, k] * dz for k in range(3)]
    front = cam[2] > 0.1
    depth = np.where(front, cam[2], 1.0)
    u = np.round(cam[0] / depth * intrinsics[0] + intrinsics[2])
    v = np.round(cam[1] / depth * intrinsics[1] + intrinsics[3])
    inside = front & (u >= 0) & (v >= 0) & (u < labels.shape[1]) & (v < labels.shape[0])
    hit = np.zeros(inside.shape, bool)
    hit[inside] = labels[v[inside].astype(int), u[inside].astype(int)] == label
    ij = np.round((seen - low) / step_m).astype(int)
    hit[ij[:, 0], ij[:, 1]] = True
    i, j = np.nonzero(_without_strays(hit))
    return np.column_stack([x[i], y[j]])


def _without_strays(hit: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The same squares without those that have fewer than three neighbours."""
    around = cv2.boxFilter(
        hit.astype(np.float32), -1, (3, 3), normalize=False, borderType=cv2.BORDER_CONSTANT
    )
    kept: NDArray[np.bool_] = hit & (around >= 4)
    return kept if kept.any() else hit


def support_detection(
    patch: Patch,
    footprint_xy: NDArray[np.float64],
    height_m: float,
    missing_border: float,
    settings: SurfaceSettings,
    detector: str,
) -> Detection | None:
    """What an upward-facing patch affords, or None where it is too small or too steep."""
    area = len(footprint_xy) * settings.footprint_step_m**2
    tilt_deg, rms = tilt_and_rms(patch.points)
    band_px = image_width(patch)
    # a floor or a stage supports however large it is
    p = membership(min(area, settings.area_m2[2]), settings.area_m2) * membership(
        tilt_deg, settings.normal_to_up_deg
    )
    p *= max(membership(band_px, BAND_PX), membership(tilt_deg, LEVEL_DEG))
    p *= max(membership(band_px, SMEAR_PX), SMEARED)
    if p <= 0:
        return None
    box = box_around(footprint_xy, height_m, settings.footprint_step_m)
    sigma = float(depth_sigma(float(np.median(patch.depth_m))))
    unsure = 0.25 * np.array(box.size_xyz[:2]) if patch.cut_by_image else np.zeros(2)
    spread = float(np.hypot(*unsure))
    return Detection(
        detector=detector,
        affordances={"SupportAbility": 0.97 * p},
        box=box,
        position_xyz=np.array([box.center_xyz[0], box.center_xyz[1], height_m]),
        covariance_xyz=np.diag([sigma**2 + spread**2 + 1e-4] * 2 + [(0.4 * sigma) ** 2 + 4e-6]),
        footprint_xy=footprint_xy,
        n_pixels=len(patch.u),
        range_m=float(np.percentile(patch.depth_m, 1)),
        image_box=patch.image_box,
        cut_by_image=patch.cut_by_image,
        extent_known=missing_border < LOST_BORDER or band_px > STRIP_PX,
        measures={
            "height": height_m,
            "area": area,
            "tilt_deg": tilt_deg,
            "rms": rms,
            "missing_border": missing_border,
            "band_px": band_px,
        },
    )


def image_width(patch: Patch) -> float:
    """Mean width of a patch across its longer direction in the image, px."""
    thin = max(1, len(patch.u) // 600)
    pixels = np.column_stack([patch.u[::thin], patch.v[::thin]]).astype(np.float32)
    _, sides, _ = cv2.minAreaRect(pixels)
    return float(len(patch.u) / (max(sides) + 1.0))


def tilt_and_rms(points: NDArray[np.float64]) -> tuple[float, float]:
    """Tilt of the plane through points (N, 3) from level, degrees, and their rms about it, m."""
    points = points[:: max(1, len(points) // 4000)]
    centred = points - points.mean(axis=0)
    xy, z = centred[:, :2], centred[:, 2]
    slope, *_ = np.linalg.lstsq(xy.T @ xy + 1e-6 * len(xy) * np.eye(2), xy.T @ z, rcond=None)
    rms = float(np.sqrt(np.mean((z - xy @ slope) ** 2)))
    return math.degrees(math.atan(float(np.hypot(*slope)))), rms
