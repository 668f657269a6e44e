"""What a simulated robot senses agrees with geometry, and its noise with what the file says."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from afkb.errors import SourceError
from afkb.testing import check_source
from afkb_mapping.geometry import back_project, transform
from afkb_simulation.source import WorldSource, open_world
from afkb_simulation.truth import load_truth

QUIET = """
sensor_noise: {axial_m: 0, axial_per_m2: 0, disparity_step_px: 0, edge_dropout: 0,
  grazing_deg: 0, laser_m: 0, range: [0, 100]}
odometry_drift: {along_per_m: 0, yaw_per_m: 0, yaw_per_rad: 0}
"""
ROOM = """
name: room
seed: 4
rooms:
  - {name: a, category: Office, rectangle: [0, 0, 4, 4], wall_height: 3}
  - {name: b, category: Office, polygon: [[4.2, 0], [8, 0], [8, 2], [6, 2], [6, 4], [4.2, 4]]}
doorways: [{between: [b, a], at: [4.1, 2], width: 0.8, height: 2.1}]
robot:
  camera: {width: 160, height: 120, pitch_down_deg: 0, height_m: 1.0, forward_m: 0}
  laser: {beams: 360, height_m: 0.3}
"""
TOUR = """
tour:
  waypoints:
    - {name: start, at: [1, 2], yaw_deg: 0, looks_deg: [0, 90, 180]}
    - {name: far, at: [5, 2], yaw_deg: 0}
    - {name: back, at: [1, 2], yaw_deg: 0}
"""


def _open(tmp_path: Path, text: str) -> tuple[str, WorldSource]:
    path = tmp_path / "room.world.yaml"
    path.write_text(text, encoding="utf-8")
    return str(path), open_world(str(path))


def test_exact_depth_and_ranges_agree_with_geometry(tmp_path: Path) -> None:
    thing = "things: [{name: block, shape: block, category: Block, at: [3, 1], size: [1, 1, 2]}]"
    uri, source = _open(tmp_path, ROOM + thing + QUIET + TOUR)
    ahead, left = next(source.views()), list(source.views())[_frame(uri, "start", 1)]
    assert left.depth_m[60, 80] == pytest.approx(2.0, abs=1e-4)
    assert left.scan.ranges_m[180] == pytest.approx(2.0, abs=1e-4)
    assert ahead.scan.ranges_m[180] == pytest.approx(7.0 - 2.0, abs=1e-3)
    points = transform(ahead.T_base_camera, back_project(ahead.depth_m, ahead.camera))
    block = points[(points[..., 1] < -0.55) & (points[..., 0] < 1.6) & (points[..., 2] > 0.1)]
    assert len(block) > 100
    assert np.abs(block[:, 0] - 1.5).max() < 1e-3
    assert np.abs(points[-5:, :60, 2]).max() < 1e-3


def _frame(uri: str, waypoint: str, look: int) -> int:
    return load_truth(uri).waypoints[waypoint].frames[look]


def test_the_doorway_is_open_below_its_lintel_and_no_wider(tmp_path: Path) -> None:
    _, source = _open(tmp_path, ROOM + QUIET + TOUR)
    view = next(source.views())
    points = view.scan.points_xy
    through = points[points[:, 0] > 3.25]
    assert len(through) > 5
    assert (np.abs(through[:, 1]) < 0.4 / 3.2 * through[:, 0] + 1e-3).all()
    jambs = points[(points[:, 0] > 3.001) & (points[:, 0] < 3.199)]
    assert np.allclose(np.abs(jambs[:, 1]), 0.4, atol=1e-4)
    x, y, z = np.moveaxis(
        transform(view.T_base_camera, back_project(view.depth_m, view.camera)), -1, 0
    )
    at_the_wall = 3 * np.stack([y, z - 1.0]) / x
    opposite = np.abs(at_the_wall[0]) < 0.39
    assert (x[opposite & (at_the_wall[1] > 1.11)] < 3.001).all()
    assert (x[opposite & (at_the_wall[1] < 1.0) & (at_the_wall[1] > -0.9)] > 3.01).all()


def test_hollow_things_are_hollow_and_closed_things_closed(tmp_path: Path) -> None:
    things = """
things:
  - {name: pot, shape: bucket, category: Pot, at: [2, 2.3], size: [0.4, 0.4, 0.25]}
  - {name: can, shape: canister, category: Canister, at: [2, 1.7], size: [0.4, 0.4, 0.5]}
"""
    text = ROOM.replace("pitch_down_deg: 0, height_m: 1.0", "pitch_down_deg: 40, height_m: 1.6")
    uri, _ = _open(tmp_path, text + things + QUIET + TOUR)
    truth = load_truth(uri)
    labels, names = truth.labels(0)
    heights = truth.heights(0)
    pot, can = (heights[labels == names.index(n)] for n in ("pot", "can"))
    assert ((pot > 0.003) & (pot < 0.007)).sum() > 20
    assert (np.abs(can - 0.5) < 1e-3).sum() > 100


BOARD_ON_A_FOOT = """
v 0 0 0\nv 0.2 0 0\nv 0.2 0.2 0\nv 0 0.2 0\nv 0.1 0.1 1
v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 6 7 8\nf 6 8 9
"""


def test_a_mesh_file_stands_on_its_foot_and_carries_things(tmp_path: Path) -> None:
    (tmp_path / "board.obj").write_text(BOARD_ON_A_FOOT, encoding="utf-8")
    things = """
things:
  - {name: board, shape: mesh, file: board.obj, category: Table, at: [3, 2], size: [1, 1, 0.6]}
  - {name: can, shape: can, category: Can, on: board, at: [-0.4, 0]}
"""
    uri, _ = _open(
        tmp_path, ROOM + things + QUIET + TOUR.replace("far, at: [5, 2]", "far, at: [1, 3]")
    )
    truth = load_truth(uri)
    board = truth.things["board"]
    assert board.top_height == pytest.approx(0.6)
    assert board.box.size_xyz == pytest.approx((1, 1, 0.6))
    assert truth.things["can"].box.center_xyz == pytest.approx((2.6, 2, 0.66))
    labels, names = truth.labels(0)
    seen = truth.heights(0)[labels == names.index("board")]
    assert (np.abs(seen - 0.6) < 1e-3).sum() > 200


@pytest.mark.parametrize("content", ["", "no mesh\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"])
def test_a_mesh_file_without_a_solid_is_refused(tmp_path: Path, content: str) -> None:
    (tmp_path / "bad.obj").write_text(content, encoding="utf-8")
    thing = "things: [{name: it, shape: mesh, file: bad.obj, category: It, at: [3, 1]}]\n"
    with pytest.raises(SourceError, match=r"\(it\)\.file: .*bad\.obj"):
        _open(tmp_path, ROOM + thing + TOUR)


def test_a_thing_comes_on_the_way_to_one_waypoint_and_goes_after_another(tmp_path: Path) -> None:
    thing = """
things:
  - name: ball
    shape: ball
    category: Ball
    at: [3, 3.5]
    present: {from: far, until: far}
"""
    uri, _ = _open(tmp_path, ROOM + thing + TOUR)
    truth = load_truth(uri)
    frames, last = truth.things["ball"].frames, truth.waypoints["start"].frames[-1]
    assert frames == tuple(range(last + 1, truth.waypoints["far"].frames[-1] + 1))
    assert truth.things["ball"].dynamic


def test_the_truth_knows_rooms_and_doorways(tmp_path: Path) -> None:
    uri, _ = _open(tmp_path, ROOM + TOUR)
    truth = load_truth(uri)
    (doorway,) = truth.doorways
    assert (doorway.x, doorway.y) == pytest.approx((4.1, 2.0))
    assert (doorway.width, doorway.height) == pytest.approx((0.8, 2.1))
    assert truth.rooms["b"].area == pytest.approx(3.8 * 2 + 1.8 * 2)
    assert truth.frame_rooms[truth.waypoints["far"].frames[0]] == "b"


def test_it_keeps_a_sources_contract(tmp_path: Path) -> None:
    check_source(_open(tmp_path, ROOM + TOUR)[1], at_most=4)


def test_axial_noise_follows_the_square_law(tmp_path: Path) -> None:
    noise = "sensor_noise: {disparity_step_px: 0, edge_dropout: 0}\n"
    uri, source = _open(tmp_path, ROOM + noise + TOUR)
    for look, z in ((0, 3.0), (2, 1.0)):
        index = _frame(uri, "start", look)
        exact = load_truth(uri).exact_depth(index)
        there = np.abs(exact - z) < 1e-3
        view = next(source.views(start=index))
        sigma = (view.depth_m - exact)[there & (view.depth_m > 0)].std()
        assert sigma == pytest.approx(0.0012 + 0.0019 * (z - 0.4) ** 2, rel=0.1)


def test_depth_comes_in_steps_as_wide_as_a_kinects(tmp_path: Path) -> None:
    # at 640 px: z² * 0.125 / (525 * 0.075), 12.7 mm at 2 m
    text = ROOM.replace("width: 160, height: 120", "width: 640, height: 480")
    uri, source = _open(tmp_path, text + TOUR)
    depth = next(source.views(start=_frame(uri, "start", 1))).depth_m
    values = np.unique(depth[(depth > 1.9) & (depth < 2.1)])
    assert np.diff(values).mean() == pytest.approx(0.0127, abs=0.001)


def test_nothing_returns_from_beyond_the_range_or_at_grazing_angles(tmp_path: Path) -> None:
    noise = "sensor_noise: {range: [0.5, 2.5], grazing_deg: 20}\n"
    _, source = _open(tmp_path, ROOM + noise + TOUR)
    depth = next(source.views()).depth_m
    assert depth[depth > 0].min() >= 0.5
    assert depth.max() <= 2.5
    rows = np.nonzero((depth > 0).any(axis=1))[0]
    assert math.atan2(rows[rows > 60].min() - 59.5, 131.3) > math.radians(19)


def test_odometry_drifts_as_said_and_not_when_told_not_to(tmp_path: Path) -> None:
    def errors(text: str) -> list[float]:
        uri, source = _open(tmp_path, text)
        T = load_truth(uri).T_world_base
        true = [np.linalg.inv(T[0]) @ t for t in T]
        pairs = zip(true, source.views(), strict=True)
        return [float(np.linalg.norm((t - v.T_odom_base)[:2, 3])) for t, v in pairs]

    assert max(errors(ROOM + QUIET + TOUR)) < 1e-9
    drifted = errors(ROOM + "odometry_drift: {along_per_m: 0.05}\n" + TOUR)
    assert drifted[0] == 0
    assert 0.01 < max(drifted) < 1.5


def test_consecutive_frames_are_near_enough_to_match_scans(tmp_path: Path) -> None:
    uri, _ = _open(tmp_path, ROOM + TOUR)
    poses = load_truth(uri).T_world_base
    for a, b in pairwise(poses):
        step = np.linalg.inv(a) @ b
        assert np.hypot(*step[:2, 3]) <= 0.4501
        assert abs(math.atan2(step[1, 0], step[0, 0])) <= math.radians(28.01)


def test_frames_are_the_same_however_they_are_read(tmp_path: Path) -> None:
    uri, source = _open(tmp_path, ROOM + TOUR)
    everything = list(source.views())
    for view in source.views(start=1, stop=9, stride=3):
        same = everything[view.index]
        assert view.depth_m.tobytes() == same.depth_m.tobytes()
        assert view.scan.ranges_m.tobytes() == same.scan.ranges_m.tobytes()
        assert view.T_odom_base.tobytes() == same.T_odom_base.tobytes()
    other = next(open_world(uri, {"seed": "5"}).views())
    assert other.depth_m.tobytes() != everything[0].depth_m.tobytes()


def test_a_robot_may_lack_a_sensor(tmp_path: Path) -> None:
    world = "name: x\nrooms: [{name: a, category: Office, rectangle: [0, 0, 4, 4]}]\n"
    tour = "tour: {waypoints: [{name: w, at: [1, 1], yaw_deg: 0}]}\n"
    _, blind = _open(tmp_path, world + "robot: {camera: null}\n" + tour)
    view = next(blind.views())
    assert view.depth_m is None
    assert view.scan is not None
    _, deaf = _open(tmp_path, world + "robot: {laser: null}\n" + tour)
    assert next(deaf.views()).scan is None


def test_a_view_and_its_source_give_nothing_of_the_truth(tmp_path: Path) -> None:
    _, source = _open(tmp_path, ROOM + TOUR)
    assert {n for n in dir(source) if not n.startswith("_")} == {"gravity_aligned", "uri", "views"}
    view = next(source.views())
    assert view.T_map_base is None
    assert view.color is None
    assert np.array_equal(view.T_odom_base, np.eye(4))
