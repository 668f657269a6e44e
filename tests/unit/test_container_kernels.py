"""Compiled loops of the container detector give what plain numpy and OpenCV give."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from afkb_containers.solid import image_solidity, thickness_and_lean
from afkb_mapping.depth_points import map_points
from afkb_mapping.from_above import sides_from_above
from afkb_mapping.openings import _border_lines, _within
from afkb_things.above import fit_supports
from afkb_things.supports import RASTER_M

RNG = np.random.default_rng(8)
INTRINSICS = np.array([60.0, 61.0, 31.5, 23.5])
TURN = cv2.Rodrigues(np.array([2.2, 0.1, 0.05]))[0]
T_MAP_CAMERA = np.block([[TURN, np.array([[0.4], [0.2], [1.3]])], [np.zeros((1, 3)), np.eye(1)]])


def test_points_of_a_depth_image_are_those_of_the_pinhole_camera() -> None:
    depth_m = RNG.uniform(0.5, 4.0, (48, 64)).astype(np.float32)
    depth_m[10:12, 5:9] = 0
    v, u = np.mgrid[:48, :64]
    fx, fy, cx, cy = INTRINSICS
    rays = np.stack([(u - cx) / fx, (v - cy) / fy, np.ones_like(u)], axis=-1)
    expected = (rays * depth_m[..., None]) @ TURN.T + T_MAP_CAMERA[:3, 3]
    expected[depth_m == 0] = 0
    assert map_points(depth_m, INTRINSICS, T_MAP_CAMERA) == pytest.approx(expected, abs=1e-5)


def test_a_tilted_support_is_fitted_by_least_squares() -> None:
    points = np.zeros((60, 60, 3), np.float32)
    points[..., :2] = RNG.uniform(0, 1, (60, 60, 2))
    points[..., 2] = 0.7 + 0.005 * (points[..., 0] - 0.5)
    raster = np.ones((int(1 / RASTER_M) + 2,) * 2, np.uint64)
    depth_m = np.ones((60, 60), np.float32)
    (plane,) = fit_supports(depth_m, points, np.array([0.7]), raster, np.zeros(2))
    x, y = points[..., 0], points[..., 1]
    assert plane[0] * x + plane[1] * y + plane[2] == pytest.approx(points[..., 2], abs=2e-4)


def test_sides_and_thickness_are_those_of_a_turned_box() -> None:
    local = RNG.uniform(-0.5, 0.5, (6000, 3)) * np.array([0.3, 0.1, 0.02])
    turn = cv2.Rodrigues(np.array([0.0, 0.0, 0.6]))[0]
    lying = local @ turn.T
    assert sides_from_above(lying) == pytest.approx((0.3 * 0.96, 0.1 * 0.96), rel=0.02)
    upright = local[:, [0, 2, 1]] @ turn.T
    thickness, lean = thickness_and_lean(upright, 0.0)
    assert thickness == pytest.approx(0.02 * 0.96, rel=0.02)
    assert lean == pytest.approx(0.0, abs=1.0)


def test_a_point_is_within_a_polygon_as_opencv_has_it() -> None:
    hull = cv2.convexHull(RNG.normal(size=(40, 2)).astype(np.float32)).reshape(-1, 2)
    for corners in (hull, hull[::-1]):
        normals, offsets = _border_lines(corners.astype(np.float64))
        for x, y in RNG.normal(size=(200, 2)):
            distance = cv2.pointPolygonTest(hull, (float(x), float(y)), True)
            assert _within(x, y, normals, offsets, 0.0) == (distance >= 0)


def test_a_ring_fills_less_of_its_hull_than_a_disc() -> None:
    v, u = np.mgrid[:40, :40].astype(np.int32)
    radius = np.hypot(u - 20, v - 20)
    disc, ring = radius < 15, (radius < 15) & (radius > 12)
    assert image_solidity(u[disc], v[disc]) > 0.95
    share = ring.sum() / disc.sum()
    assert image_solidity(u[ring], v[ring]) == pytest.approx(share, abs=0.05)
