"""Free floor of one view, by laser, by depth, and by both."""

from dataclasses import replace

import numpy as np
import pytest

import depth_samples as depth
import laser_samples as laser
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.panorama import bearing, panorama_of
from afkb_mapping.view_floor import area_m2, free_floor

WALL = depth.Box((3.0, -6.0, 0.0), (3.2, 6.0, 3.0))
ROOM = np.array([[[-2, -2], [3, -2]], [[3, -2], [3, 2]], [[3, 2], [-2, 2]], [[-2, 2], [-2, -2]]])


def scan_view():
    view = laser.view(ROOM.astype(float), (0, 0, 0), (0, 0, 0), beams=720)
    return replace(view, T_map_base=T_from_xy_yaw(0, 0, 0))


def test_a_scan_gives_the_room():
    (outline,) = free_floor(scan_view())
    assert area_m2(outline) == pytest.approx(20, rel=0.02)


def test_depth_gives_the_part_in_view_up_to_the_wall():
    (outline,) = free_floor(depth.view_of([depth.FLOOR, WALL], 1.2, 0.0))
    assert outline[:, 0].max() == pytest.approx(3.0, abs=0.05)
    half_width = 3.0 * 0.5 * depth.CAMERA.width / depth.CAMERA.fx
    assert area_m2(outline) == pytest.approx(3.0 * half_width, rel=0.05)


def test_depth_sees_the_table_that_a_laser_looks_under():
    seen = depth.view_of([depth.FLOOR, WALL, depth.table(1.6, 0.0, 0.75)], 1.2, 20.0)
    scan = scan_view()
    both = replace(seen, scan=scan.scan, T_base_laser=scan.T_base_laser)
    (with_table,), (without,) = free_floor(both), free_floor(scan)
    assert area_m2(with_table) < area_m2(without) - 1.0


def test_low_and_tall_are_told_apart():
    things = [depth.FLOOR, WALL, depth.Box((2.0, -0.5, 0.0), (2.4, 0.5, 0.8))]
    panorama = panorama_of(depth.view_of(things, 1.3, 10.0))
    index, _ = panorama.at(np.array([[2.0, 0.0], [3.0, 1.2]]))
    assert panorama.low_m[index] == pytest.approx([2.0, 3.23], abs=0.05)
    assert panorama.tall_m[index] == pytest.approx([3.0, 3.23], abs=0.05)


def test_without_depth_and_scan_there_is_none():
    assert panorama_of(scan_view()) is None


def test_bearings_are_those_of_atan2():
    for angle in [*np.linspace(-3.14, 3.14, 100), 0.0, np.pi / 4, np.pi / 2, np.pi]:
        y, x = 2 * np.sin(angle), 2 * np.cos(angle)
        assert bearing(y, x) == pytest.approx(np.arctan2(y, x), abs=2e-5)
    assert bearing(0.0, 0.0) == 0.0
