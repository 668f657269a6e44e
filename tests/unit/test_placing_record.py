"""What is told of a recording's gaps, and which views wait until their place is sure."""

import numpy as np

from afkb.flow import PinholeCamera, View
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.placing.frame_gaps import FrameGaps
from afkb_mapping.placing.held_views import HELD_LOOKS, MOST_HELD, HeldViews
from afkb_mapping.placing.record import PlacingRecord
from afkb_mapping.placing.scan_surface import SurfacePoints, no_surface
from afkb_mapping.placing.surface_map import SurfaceMap
from afkb_mapping.placing.view_surface import ViewSurface

NOTHING = ViewSurface(no_surface(), no_surface())


def view_at(index, x):
    camera = PinholeCamera(2, 2, 1.0, 1.0, 1.0, 1.0)
    depth = np.ones((2, 2), np.float32)
    return View(index, 0.1 * index, T_from_xy_yaw(x, 0, 0), depth, camera, np.eye(4))


def gaps_of(stamps, indices=None):
    gaps = FrameGaps()
    for index, stamp in zip(indices or range(len(stamps)), stamps, strict=True):
        gaps.see(stamp, index)
    return gaps


def test_frames_that_never_came_are_counted_and_told():
    came = [n for n in range(60) if n not in (7, 8, 20, 41, 42, 43)]
    rng = np.random.default_rng(1)
    gaps = gaps_of([0.2 * n + rng.uniform(0, 0.02) for n in came])
    assert gaps.lost == 6
    assert "about 6 frames (10%)" in gaps.note and "frame 37" in gaps.note
    assert PlacingRecord(gaps=gaps).counts["lost_frames"] == 6


def test_frames_left_out_or_taken_at_will_are_no_gaps():
    whole = [0.2 * n for n in range(40)]
    assert gaps_of(whole).note is None
    assert gaps_of(whole[:10] + whole[15:], [*range(10), *range(15, 40)]).lost == 0
    assert gaps_of(np.cumsum(np.geomspace(0.1, 30, 40)).tolist()).note is None


def test_a_view_waits_until_looks_from_elsewhere_follow():
    held = HeldViews()
    for index in range(HELD_LOOKS):
        held.hold(view_at(index, 0.5 * index), NOTHING)
    for index in range(HELD_LOOKS, HELD_LOOKS + 5):  # standing still
        held.hold(view_at(index, 0.5 * (HELD_LOOKS - 1)), NOTHING)
    assert 0 in held
    held.hold(view_at(99, 9.0), NOTHING)
    assert 0 not in held and 1 in held and held.settled == 1
    held.withdraw()
    assert held.withdrawn == {*range(1, HELD_LOOKS + 5), 99} and 1 not in held


def test_no_more_views_wait_than_memory_has_room_for():
    held = HeldViews()
    for index in range(MOST_HELD + 3):
        held.hold(view_at(index, 0.0), NOTHING)
    assert 2 not in held and 3 in held


def test_what_is_taken_back_leaves_the_map_as_it_was():
    points = np.array([[0.0, 1.0], [0.31, 1.0], [2.0, 1.0]])
    normals = np.tile([0.0, -1.0], (3, 1))
    wall = SurfacePoints.of_laser(points, normals)
    again = SurfacePoints.of_laser(points + np.array([0.011, 0.013]), normals)
    more = SurfacePoints.of_laser(points + np.array([5.0, 0.0]), normals)
    surface_map = SurfaceMap()
    surface_map.add(wall)
    for surface in (again, more):
        surface_map.add(surface)
    for surface in (more, again):
        surface_map.remove(surface)
    assert np.allclose(surface_map.all().points_xy, points)
    assert np.allclose(surface_map.near(np.zeros(2), 9.0).points_xy, points)
