"""Placing views: odometry corrected by laser scans."""

import contextlib
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import laser_samples as samples
from afkb.errors import BadFrame
from afkb.flow import LaserScan, View
from afkb_mapping.geometry import T_from_xy_yaw, wrap_angle, yaw_of
from afkb_mapping.placing.record import PlacingRecord
from afkb_mapping.placing.registration import ScanRegistration

PATH = [(1 + 0.3 * i, 2.5, 0.1 * i) for i in range(10)]
PATH += [(3.7 + 0.4 * i, 3.95, 0.9 - 0.2 * i) for i in range(1, 9)]


def drifting(path, rng, sigmas=(0.03, 0.03, 0.04)):
    """Odometry of a path whose steps err by a few centimetres and degrees, starting anywhere."""
    odom = [T_from_xy_yaw(3, -2, 1.0)]
    for a, b in pairwise(path):
        step = np.linalg.inv(T_from_xy_yaw(*a)) @ T_from_xy_yaw(*b)
        slip = T_from_xy_yaw(*rng.normal(0, sigmas))
        odom.append(odom[-1] @ step @ slip)
    return [(T[0, 3], T[1, 3], yaw_of(T)) for T in odom]


def errors(placed, path):
    start = np.linalg.inv(T_from_xy_yaw(*path[0]))
    truth = [start @ T_from_xy_yaw(*p) for p in path]
    shift = [np.linalg.norm((p.T_map_base - t)[:2, 3]) for p, t in zip(placed, truth, strict=True)]
    turn = [
        abs(wrap_angle(yaw_of(p.T_map_base) - yaw_of(t)))
        for p, t in zip(placed, truth, strict=True)
    ]
    return np.array(shift), np.array(turn)


def place_all(views):
    registration = ScanRegistration(np.linalg.inv(views[0].T_odom_base))
    return [registration.place(v) for v in views]


def test_drifting_odometry_is_corrected_to_centimetres():
    rng = np.random.default_rng(1)
    odom = drifting(PATH, rng)
    views = [
        samples.view(samples.FLAT, p, o, i, rng)
        for i, (p, o) in enumerate(zip(PATH, odom, strict=True))
    ]
    placed = place_all(views)
    shift, turn = errors(placed, PATH)
    assert all(p.matched for p in placed)
    assert shift.max() < 0.03
    assert math.degrees(turn.max()) < 0.5


def test_without_a_laser_what_stands_upright_in_depth_corrects_odometry():
    rng = np.random.default_rng(1)
    turns = [(2.5, 2.5, 0.5 * i) for i in range(13)] + [
        (2.5 + 0.3 * i, 2.5, 6.3) for i in (1, 2, 3)
    ]
    odom = drifting(turns, rng, (0.01, 0.01, 0.03))
    views = [
        samples.depth_view(samples.FLAT, p, o, i, rng)
        for i, (p, o) in enumerate(zip(turns, odom, strict=True))
    ]
    placed = place_all(views)
    shift, turn = errors(placed, turns)
    assert shift.max() < 0.05
    assert math.degrees(turn.max()) < 1.5


def test_given_camera_poses_are_kept():
    rng = np.random.default_rng(2)
    poses = [(2.5, 2.5, 0.0), (2.5, 2.5, 0.1)]
    given = [(0.0, 0.0, 0.0), (0.05, 0.02, 0.1)]
    registration = ScanRegistration(np.eye(4))
    for index, (pose, claimed) in enumerate(zip(poses, given, strict=True)):
        view = samples.depth_view(samples.FLAT, pose, claimed, index, rng)
        placed = registration.place(replace(view, has_base=False))
        assert np.array_equal(placed.T_map_base, T_from_xy_yaw(*claimed))


def test_an_earlier_visit_is_matched_as_recalled():
    rng = np.random.default_rng(3)
    earlier = samples.view(samples.FLAT, (2, 2, 0.3), (0, 0, 0), 0, rng)
    registration = ScanRegistration(np.eye(4))
    registration.recall(replace(earlier, T_map_base=T_from_xy_yaw(2, 2, 0.3)))
    placed = registration.place(samples.view(samples.FLAT, (2.1, 2, 0.3), (2.14, 2.03, 0.32)))
    assert np.linalg.norm(placed.T_map_base[:2, 3] - [2.1, 2.0]) < 0.01


def test_covers_a_slip_that_icp_alone_would_not_reach():
    rng = np.random.default_rng(2)
    path = [(2, 2, 0.0), (2.3, 2, 0.0), (2.6, 2, 0.0), (2.9, 2, 0.0)]
    odom = [(0, 0, 0.0), (0.3, 0, 0.0), (0.9, 0.2, 0.25), (1.2, 0.28, 0.25)]
    views = [
        samples.view(samples.FLAT, p, o, i, rng)
        for i, (p, o) in enumerate(zip(path, odom, strict=True))
    ]
    shift, turn = errors(place_all(views), path)
    assert shift.max() < 0.03
    assert math.degrees(turn.max()) < 0.5


def test_along_a_corridor_odometry_rules_and_its_doubt_is_told():
    rng = np.random.default_rng(3)
    path = [(0.5 * i, 0.0, 0.0) for i in range(6)]
    odom = [(0.5 * i, 0.01 * i * i, 0.01 * i) for i in range(6)]
    views = [
        samples.view(samples.CORRIDOR, p, o, i, rng)
        for i, (p, o) in enumerate(zip(path, odom, strict=True))
    ]
    last = place_all(views)[-1]
    assert last.T_map_base[0, 3] == pytest.approx(2.5, abs=0.15)
    assert last.T_map_base[1, 3] == pytest.approx(0.0, abs=0.02)
    assert last.covariance[0, 0] > 20 * last.covariance[1, 1]


def test_blind_laser_leaves_the_pose_to_odometry():
    first = samples.view(samples.FLAT, (2, 2, 0), (0, 0, 0))
    registration = ScanRegistration(np.eye(4))
    registration.place(first)
    blind = LaserScan(np.full(360, np.inf, np.float32), -math.pi, math.pi / 180, 0.05, 12.0)
    pose = T_from_xy_yaw(0.4, 0.1, 0.2)
    placed = registration.place(View(1, 1.0, pose, scan=blind, T_base_laser=np.eye(4)))
    assert not placed.matched
    assert np.allclose(placed.T_map_base, pose)
    assert placed.covariance[0, 0] > 0


def test_height_and_tilt_of_levelled_odometry_stay():
    tilt = np.eye(4)
    tilt[1:3, 1:3] = [[math.cos(0.05), -math.sin(0.05)], [math.sin(0.05), math.cos(0.05)]]
    tilt[2, 3] = 0.12
    registration = ScanRegistration(np.eye(4))
    registration.place(samples.view(samples.FLAT, (2, 2, 0), (0, 0, 0)))
    moved = samples.view(samples.FLAT, (2.3, 2, 0), (0.35, 0.05, 0.03), 1)
    moved = View(1, 1.0, moved.T_odom_base @ tilt, scan=moved.scan, T_base_laser=moved.T_base_laser)
    T = registration.place(moved).T_map_base
    assert T[2, 3] == pytest.approx(0.12)
    assert T[2, :3] == pytest.approx(tilt[2, :3], abs=1e-9)


def test_furniture_that_moved_does_not_pull_the_pose():
    rng = np.random.default_rng(4)
    changed = samples.FLAT.copy()
    changed[6:, :, 0] += 0.15
    views = [samples.view(samples.FLAT, (2, 2, 0), (0, 0, 0), 0, rng)]
    views += [samples.view(changed, (2, 2, 0), (0, 0, 0), i, rng) for i in range(1, 4)]
    shift, _ = errors(place_all(views), [(2, 2, 0)] * 4)
    assert shift.max() < 0.02


def test_the_same_views_are_placed_alike_twice():
    rng = np.random.default_rng(5)
    odom = drifting(PATH, rng)
    views = [
        samples.view(samples.FLAT, p, o, i, rng)
        for i, (p, o) in enumerate(zip(PATH, odom, strict=True))
    ]
    once, again = place_all(views), place_all(views)
    assert all(np.array_equal(a.T_map_base, b.T_map_base) for a, b in zip(once, again, strict=True))


def placed_or_skipped(views, record):
    registration = ScanRegistration(np.linalg.inv(views[0].T_odom_base), record)
    for view in views:
        try:
            yield registration.place(view)
        except BadFrame:
            yield None


def test_a_robot_that_was_carried_is_lost_and_finds_itself_in_its_map():
    rng = np.random.default_rng(6)
    there = [(7.5 - 0.3 * i, 4.8, 2.5) for i in range(5)]
    way = PATH + there + [(1.2 + 0.3 * i, 2.5, 0.1 * i) for i in range(7)]
    carried = np.linalg.inv(T_from_xy_yaw(1.2, 2.5, 0.0))
    on = [T_from_xy_yaw(*there[-1]) @ carried @ T_from_xy_yaw(*p) for p in way[-7:]]
    odom = PATH + there + [(T[0, 3], T[1, 3], yaw_of(T)) for T in on]
    views = [
        samples.view(samples.FLAT, p, o, i, rng)
        for i, (p, o) in enumerate(zip(way, odom, strict=True))
    ]
    record = PlacingRecord()
    placed = list(placed_or_skipped(views, record))
    lost = [i for i, p in enumerate(placed) if p is None]
    assert lost and lost[0] == len(PATH + there)
    assert record.counts["lost_views"] == len(lost) < 4
    assert record.counts["found_again"] == 1
    used = [(p, w) for p, w in zip(placed, way, strict=True) if p is not None]
    shift, _ = errors([p for p, _ in used], [w for _, w in used])
    assert shift.max() < 0.05


def test_another_place_leaves_the_map_as_it_was():
    rng = np.random.default_rng(7)
    elsewhere = np.array(
        [[[0, 0], [4, 0]], [[4, 0], [2, 7]], [[2, 7], [0, 0]], [[1.5, 3], [2.2, 2.4]]], dtype=float
    )
    other = [(1.6 + 0.1 * i, 1.5, 0.3 * i) for i in range(4)]
    views = [samples.view(samples.FLAT, p, p, i, rng) for i, p in enumerate(PATH)]
    views += [samples.view(elsewhere, p, PATH[-1], 100 + i, rng) for i, p in enumerate(other)]
    record = PlacingRecord()
    placed = list(placed_or_skipped(views, record))
    assert None not in placed[: len(PATH)]
    assert placed[len(PATH) :] == [None] * len(other)
    assert "lost from frame 100 on: 4 views" in record.notes[0]


def test_by_depth_alone_no_view_is_used_before_its_place_is_sure():
    rng = np.random.default_rng(8)
    turning = [(2.5, 2.5, 0.5 * i) for i in range(13)]
    there = PATH[6:]
    way = turning + there + turning[2:10]  # carried back, and turned around
    T_there_back = T_from_xy_yaw(*there[-1]) @ np.linalg.inv(T_from_xy_yaw(*turning[2]))
    on = [T_there_back @ T_from_xy_yaw(*p) for p in turning[2:10]]
    odom = turning + there + [(T[0, 3], T[1, 3], yaw_of(T)) for T in on]
    registration, placed = ScanRegistration(np.linalg.inv(T_from_xy_yaw(*way[0]))), {}
    for i, (p, o) in enumerate(zip(way, odom, strict=True)):
        with contextlib.suppress(BadFrame):
            placed[i] = registration.place(samples.depth_view(samples.FLAT, p, o, i, rng))
    registration.end()
    carried = len(turning + there)
    used = [i for i in placed if i not in registration.held.withdrawn]
    assert registration.held.withdrawn and carried not in used
    assert len(used) > carried - 7 and max(used) > carried
    shift, _ = errors([placed[i] for i in used], [way[i] for i in used])
    assert shift.max() < 0.06
