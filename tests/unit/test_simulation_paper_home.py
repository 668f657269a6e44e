"""The bundled home is the paper's Fig. 2, row by row."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from afkb_simulation.reading import read_world
from afkb_simulation.simulation import Simulation
from afkb_simulation.truth import WorldTruth, load_truth

HOME = "world:paper_home"
ON_THE_TABLE = ("pot", "canister_1", "bowl", "carton", "mug_1", "jug")


@pytest.fixture(scope="module")
def truth() -> WorldTruth:
    return load_truth(HOME)


def _top_pixels(truth: WorldTruth, name: str, index: int) -> int:
    labels, names = truth.labels(index)
    level = np.abs(truth.heights(index) - truth.things[name].top_height) < 2e-3
    return int((level & (labels == names.index(name))).sum())


def _best(truth: WorldTruth, waypoint: str, name: str) -> int:
    return max(truth.visible_pixels(f).get(name, 0) for f in truth.waypoints[waypoint].frames)


def test_six_waypoints_lead_through_four_rooms(truth: WorldTruth) -> None:
    rooms = [w.room for w in truth.waypoints.values()]
    assert rooms == ["kitchen", "bedroom", "bathroom", "kitchen", "hall", "hall"]
    categories = {r.category for r in truth.rooms.values()}
    assert categories == {"Kitchen", "Bedroom", "Bathroom", "LivingRoom"}
    assert 60 <= len(truth.T_world_base) <= 110


def test_row_1_shows_containers_and_hides_the_table_under_them(truth: WorldTruth) -> None:
    before_return = range(truth.waypoints["kitchen_again"].frames[0])
    at_first = [f for f in before_return if truth.frame_rooms[f] == "kitchen" and f < 15]
    assert sum(_top_pixels(truth, "kitchen_table", f) for f in at_first) == 0
    for name in ON_THE_TABLE:
        assert truth.things[name].on == "kitchen_table"
        assert _best(truth, "kitchen", name) > 600


def test_row_1_lets_the_camera_look_into_the_open_ones(truth: WorldTruth) -> None:
    labels, names = truth.labels(0)
    depth = truth.exact_depth(0)
    for name in ("pot", "bowl", "mug_1", "jug"):
        there = labels == names.index(name)
        column = np.nonzero(there.sum(axis=0) == there.sum(axis=0).max())[0][0]
        along = depth[there[:, column], column]
        assert along[0] - along.min() > 0.6 * truth.things[name].box.size_xyz[0]


def test_row_2_shows_one_large_low_support(truth: WorldTruth) -> None:
    frame = truth.waypoints["bedroom"].frames[1]
    assert _top_pixels(truth, "bed", frame) > 20000
    assert truth.things["bed"].top_height == pytest.approx(0.5)


def test_row_3_shows_few_containers(truth: WorldTruth) -> None:
    for name, least in (("bathtub", 20000), ("sink", 10000), ("cup", 600), ("beaker", 600)):
        assert _best(truth, "bathroom", name) > least


def test_row_4_sees_the_table_top_from_the_other_side(truth: WorldTruth) -> None:
    frames = truth.waypoints["kitchen_again"].frames
    assert max(_top_pixels(truth, "kitchen_table", f) for f in frames) > 5000
    first, again = truth.waypoints["kitchen"], truth.waypoints["kitchen_again"]
    table = truth.things["kitchen_table"].box.center_xyz
    assert first.x < table[0] < again.x


def test_row_5_has_blocks_that_are_gone_in_row_6(truth: WorldTruth) -> None:
    assert truth.things["blocks"].dynamic
    assert _best(truth, "hall_entrance", "blocks") > 5000
    later = range(truth.waypoints["hall_entrance"].frames[-1] + 1, len(truth.frame_rooms))
    assert all("blocks" not in truth.visible_pixels(f) for f in later)
    place = truth.things["blocks"].box.center_xyz
    assert any(_looks_at(truth, f, place) for f in later)


def _looks_at(truth: WorldTruth, index: int, point: tuple[float, float, float]) -> bool:
    """Whether the camera sees free space at the point: something farther along its ray."""
    camera = truth.camera
    x, y, z = (np.linalg.inv(truth.T_world_camera(index)) @ [*point, 1.0])[:3]
    u, v = (int(c) for c in (camera.matrix @ [x / z, y / z, 1])[:2])
    inside = z > 0 and 0 <= u < camera.width and 0 <= v < camera.height
    return inside and truth.exact_depth(index)[v, u] > z + 0.1


def test_row_6_shows_supports_at_table_and_seat_height(truth: WorldTruth) -> None:
    frames = truth.waypoints["hall"].frames
    for name in ("dining_table", "coffee_table", "couch_1", "couch_2", "chair_1", "chair_2"):
        assert max(_top_pixels(truth, name, f) for f in frames) > 3000, name


def test_the_way_is_free(truth: WorldTruth) -> None:
    radius = read_world(HOME).robot.radius_m
    for index, T in enumerate(truth.T_world_base):
        for thing in truth.things.values():
            if index in thing.frames and thing.box.bottom < 1.3:
                assert _gap(T, thing.box) > radius, (index, thing.name)


def _gap(T: np.ndarray, box) -> float:
    dx, dy = T[0, 3] - box.center_xyz[0], T[1, 3] - box.center_xyz[1]
    c, s = math.cos(box.yaw), math.sin(box.yaw)
    along, across = abs(c * dx + s * dy), abs(-s * dx + c * dy)
    return math.hypot(max(0, along - box.size_xyz[0] / 2), max(0, across - box.size_xyz[1] / 2))


def test_no_wall_comes_nearer_than_the_robot_is_wide(truth: WorldTruth) -> None:
    world = read_world(HOME)
    robot = world.robot.model_copy(update={"camera": None})
    simulation = Simulation(world.model_copy(update={"robot": robot}), Path(HOME))
    for index in range(len(simulation.stops)):
        assert simulation.view(index).scan.ranges_m.min() > robot.radius_m


def test_things_stand_apart(truth: WorldTruth) -> None:
    """No two things of the home pass through each other."""
    things = list(truth.things.values())
    for i, a in enumerate(things):
        for b in things[i + 1 :]:
            if b.on != a.name and a.on != b.name and _overlap(a.box, b.box):
                raise AssertionError(f"{a.name} and {b.name} overlap")


def _overlap(a, b) -> bool:
    if a.bottom >= b.top - 1e-6 or b.bottom >= a.top - 1e-6:
        return False
    delta = np.array(b.center_xyz[:2]) - a.center_xyz[:2]
    axes = [np.array([math.cos(y), math.sin(y)]) for y in (a.yaw, b.yaw)]
    axes += [np.array([-v[1], v[0]]) for v in axes]
    return all(abs(delta @ n) < _reach(a, n) + _reach(b, n) - 1e-6 for n in axes)


def _reach(box, n: np.ndarray) -> float:
    c, s = math.cos(box.yaw), math.sin(box.yaw)
    along, across = abs(n @ [c, s]), abs(n @ [-s, c])
    return along * box.size_xyz[0] / 2 + across * box.size_xyz[1] / 2
