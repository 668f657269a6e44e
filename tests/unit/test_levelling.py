"""The floor is found whatever frame the poses came in."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from afkb.flow import PinholeCamera, View
from afkb_mapping.geometry import transform
from afkb_mapping.placing.levelling import level

CAMERA = PinholeCamera(160, 120, 140.0, 140.0, 79.5, 59.5)
T_BASE_CAMERA = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])


def depth_of_room(T_world_camera, table=True):
    """Depth of a floor at z = 0, a wall at x = 4 and a table top at 0.75 m, by ray and plane."""
    v, u = np.mgrid[0 : CAMERA.height, 0 : CAMERA.width]
    rays = np.stack(
        [(u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy, np.ones(u.shape)], axis=-1
    )
    directions = rays @ T_world_camera[:3, :3].T
    origin = T_world_camera[:3, 3]
    with np.errstate(divide="ignore"):
        floor = -origin[2] / directions[..., 2]
        wall = (4 - origin[0]) / directions[..., 0]
        top = (0.75 - origin[2]) / directions[..., 2]
    hit = origin + top[..., None] * directions
    on_table = (hit[..., 0] > 1.5) & (hit[..., 0] < 2.3) & (np.abs(hit[..., 1]) < 0.6) & (top > 0)
    far = np.where(floor > 0, floor, np.inf)
    far = np.minimum(far, np.where(wall > 0, wall, np.inf))
    depth = np.where(on_table & table, np.minimum(top, far), far)
    return np.where(depth < 6, depth, 0).astype(np.float32)


def views_in(T_source_world):
    views = []
    for i, yaw in enumerate(np.linspace(-0.5, 0.5, 6)):
        T_world_base = np.eye(4)
        T_world_base[:3, :3] = Rotation.from_euler("ZY", [yaw, 0.45]).as_matrix()
        T_world_base[:3, 3] = 0.1 * i, 0.05, 1.3
        depth = depth_of_room(T_world_base @ T_BASE_CAMERA)
        T = T_source_world @ T_world_base
        views.append(View(i, i / 10, T, depth, CAMERA, T_BASE_CAMERA, has_base=False))
    return views


@pytest.mark.parametrize("euler_deg", [(0, 0, 0), (20, 80, -35), (90, 5, 120)])
def test_floor_becomes_z_0_in_any_pose_frame(euler_deg):
    T_source_world = np.eye(4)
    T_source_world[:3, :3] = Rotation.from_euler("xyz", euler_deg, degrees=True).as_matrix()
    T_source_world[:3, 3] = 3.0, -2.0, 7.0
    found = level(views_in(T_source_world), gravity_aligned=False)
    assert found.note is None
    T_map_world = found.T_map_source @ T_source_world
    assert T_map_world[2, 2] > np.cos(np.deg2rad(0.5))
    corners = np.array([[0, 0, 0], [3, 0, 0], [3, 2, 0], [0, -2, 0.0]])
    np.testing.assert_allclose(transform(T_map_world, corners)[:, 2], 0, atol=0.03)


def test_the_first_pose_is_the_origin_with_x_ahead():
    views = views_in(np.eye(4))
    T_map_base = level(views, gravity_aligned=False).T_map_source @ views[0].T_odom_base
    np.testing.assert_allclose(T_map_base[:2, 3], 0, atol=1e-9)
    assert T_map_base[2, 3] == pytest.approx(1.3, abs=0.03)
    assert T_map_base[1, 0] == pytest.approx(0, abs=1e-9)
    assert T_map_base[0, 0] > 0


def test_a_robot_without_depth_stands_on_the_floor():
    from afkb.flow import LaserScan

    scan = LaserScan(np.full(90, 2.0, np.float32), -1.5, 0.03, 0.1, 30.0)
    T = np.eye(4)
    T[:3, 3] = 5.0, 1.0, 0.0
    view = View(0, 0.0, T, scan=scan, T_base_laser=np.eye(4))
    found = level([view], gravity_aligned=True)
    np.testing.assert_allclose((found.T_map_source @ T)[:3, 3], 0, atol=1e-12)


def test_where_no_floor_is_seen_the_map_says_so():
    depth = np.full((CAMERA.height, CAMERA.width), 1.0, np.float32)
    view = View(0, 0.0, np.eye(4), depth, CAMERA, T_BASE_CAMERA, has_base=False)
    assert level([view], gravity_aligned=False).note is not None
