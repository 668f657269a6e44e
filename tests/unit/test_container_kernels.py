"""Compiled loops of the container detector give what plain numpy and OpenCV give."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from afkb_containers.noise import noise_of
from afkb_containers.silhouette import silhouette_of
from afkb_containers.spread import Spread, spread_of
from afkb_mapping.bodies import Body, Stand
from afkb_mapping.depth_points import points_of_row
from afkb_mapping.from_above import sides_from_above
from afkb_mapping.opening_kernels import border_lines, within
from afkb_mapping.view_noise import noise_scale
from afkb_things.above import fit_supports
from afkb_things.supports import RASTER_M

RNG = np.random.default_rng(8)
INTRINSICS = np.array([60.0, 61.0, 31.5, 23.5])
TURN = cv2.Rodrigues(np.array([2.2, 0.1, 0.05]))[0]
T_MAP_CAMERA = np.block([[TURN, np.array([[0.4], [0.2], [1.3]])], [np.zeros((1, 3)), np.eye(1)]])


def map_points(depth_m: np.ndarray) -> np.ndarray:
    """(H, W, 3) float32, map frame."""
    row, points = np.empty((3, depth_m.shape[1]), np.float32), np.empty((*depth_m.shape, 3))
    for v in range(len(depth_m)):
        points_of_row(depth_m, v, INTRINSICS, T_MAP_CAMERA, row, 0, depth_m.shape[1])
        points[v] = row.T
    return points


def test_points_of_a_depth_image_are_those_of_the_pinhole_camera() -> None:
    depth_m = RNG.uniform(0.5, 4.0, (48, 64)).astype(np.float32)
    v, u = np.mgrid[:48, :64]
    fx, fy, cx, cy = INTRINSICS
    rays = np.stack([(u - cx) / fx, (v - cy) / fy, np.ones_like(u)], axis=-1)
    expected = (rays * depth_m[..., None]) @ TURN.T + T_MAP_CAMERA[:3, 3]
    assert map_points(depth_m) == pytest.approx(expected, abs=1e-5)


def test_a_tilted_support_is_fitted_by_least_squares() -> None:
    u, v = np.meshgrid(np.arange(64), np.arange(48))
    rays = np.stack([(u - 31.5) / 60, (v - 23.5) / 61, np.ones_like(u)], axis=-1) @ TURN.T
    low = np.array([0.2, -0.5, 0.7])  # it rises by 5 mm per metre of x
    up = np.array([-0.005, 0.0, 1.0])
    depth_m = ((low - T_MAP_CAMERA[:3, 3]) @ up / (rays @ up)).astype(np.float32)
    points = map_points(depth_m)
    origin = points[..., :2].reshape(-1, 2).min(axis=0).astype(float)
    raster = np.ones(
        np.ceil(np.ptp(points[..., :2], axis=(0, 1)) / RASTER_M).astype(int), np.uint64
    )
    heights = np.array([0.7])
    (plane,) = fit_supports(depth_m, INTRINSICS, T_MAP_CAMERA, heights, raster, origin)
    assert plane[:2] == pytest.approx([0.005, 0.0], abs=2e-4)
    x, y = points[..., 0] - origin[0], points[..., 1] - origin[1]
    assert plane[0] * x + plane[1] * y + plane[2] == pytest.approx(points[..., 2], abs=2e-4)


def test_sides_are_those_of_a_turned_box() -> None:
    local = RNG.uniform(-0.5, 0.5, (6000, 3)) * np.array([0.3, 0.1, 0.02])
    lying = local @ cv2.Rodrigues(np.array([0.0, 0.0, 0.6]))[0].T
    assert sides_from_above(lying) == pytest.approx((0.3 * 0.96, 0.1 * 0.96), rel=0.02)


def body_of(depth_m: np.ndarray, points: np.ndarray) -> Body:
    v, u = np.nonzero(depth_m)
    depths = depth_m[v, u].astype(np.float32)
    return Body(
        u.astype(np.int32), v.astype(np.int32), depths, points[v, u], depth_m.shape,
        Stand.ON_SUPPORT, 0.0,
    )  # fmt: skip


def plate(lean_deg: float, sigma_m: float) -> Spread:
    """A plate 0.2 m wide and high, 2 m away, that leans back."""
    rng = np.random.default_rng(3)
    rows, cols = np.mgrid[-0.1:0.1:60j, -0.1:0.1:60j]
    x = 2.0 + rows * np.tan(np.radians(lean_deg)) + rng.normal(0, sigma_m, rows.shape)
    body = body_of(x, np.stack([x, cols * x / 2, rows * x / 2], -1))
    return spread_of(body, np.zeros(3), sigma_m, np.arange(len(body.u)))


def test_a_plate_is_thin_and_leans_whatever_the_noise() -> None:
    for sigma_m in (0.001, 0.004, 0.010):
        seen = plate(12.0, sigma_m)
        assert seen.least_m < 0.004
        assert seen.most_m >= seen.thickness_m >= seen.least_m
        assert seen.lean_deg == pytest.approx(12.0, abs=1.5)
        assert seen.shape < 0.15


def test_noise_is_the_models_unless_more_is_seen() -> None:
    rng = np.random.default_rng(4)
    for sigma_m in (0.0005, 0.03):
        x = 1.5 + rng.normal(0, sigma_m, (240, 320))
        scale = noise_scale(x.astype(np.float32))
        assert scale == pytest.approx(max(sigma_m / 0.0035, 1.0), rel=0.1)
        seen = noise_of(body_of(x[:40, :40], np.zeros((40, 40, 3))), x.astype(np.float32), scale)
        assert seen.sigma_m == pytest.approx(max(sigma_m, 0.0035), rel=0.1)
        assert seen.roughness < 1.2


def test_a_point_is_within_a_polygon_as_opencv_has_it() -> None:
    hull = cv2.convexHull(RNG.normal(size=(40, 2)).astype(np.float32)).reshape(-1, 2)
    for corners in (hull, hull[::-1]):
        normals, offsets = border_lines(corners.astype(np.float64))
        for x, y in RNG.normal(size=(200, 2)):
            distance = cv2.pointPolygonTest(hull, (float(x), float(y)), True)
            assert within(x, y, normals, offsets, 0.0) == (distance >= 0)


def outline(shown: np.ndarray, depth_m: np.ndarray) -> tuple[float, float]:
    body = body_of(np.where(shown, depth_m, 0.0), np.zeros((*depth_m.shape, 3)))
    found = silhouette_of(body, depth_m.astype(np.float32), 525.0, 0.003)
    return found.solidity, found.core_share


def test_a_handle_is_no_part_of_the_core_and_what_is_hidden_is_no_dent() -> None:
    v, u = np.mgrid[:90, :90]
    mug = (abs(u - 35) < 20) & (abs(v - 45) < 30)
    handle = (np.hypot(u - 56, v - 45) < 18) & (np.hypot(u - 56, v - 45) > 14) & (u >= 55)
    behind = np.full(mug.shape, 1.5)
    depth_m = np.where(mug | handle, 1.0, behind)
    solidity, core_share = outline(mug | handle, depth_m)
    assert solidity > 0.95
    assert core_share == pytest.approx(mug.sum() / (mug | handle).sum(), abs=0.03)
    bar = (v > 40) & (v < 50)
    assert outline(mug & ~bar, np.where(bar & mug, 0.6, depth_m))[0] > 0.95
    assert outline(mug & (u + v < 85), behind - 0.5 * mug)[0] > 0.9
    wide = (abs(v - 45) < 10) & (abs(u - 45) < 30) | (abs(u - 45) < 10) & (abs(v - 45) < 30)
    assert outline(wide, behind)[0] < 0.8
