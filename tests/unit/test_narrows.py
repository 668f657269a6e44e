"""Doorways from the map alone: narrow places, straight runs, and what depth views make together."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import depth_samples as depth
from afkb.flow import OccupancyGrid, PinholeCamera
from afkb.knowledge import Trapezoid
from afkb_mapping.doorways.merger import DoorwayMerger, passage_width
from afkb_mapping.doorways.narrows import gaps_of_map
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.grid.input import insert_view
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.grid.straight_runs import runs_m, thickness_m

SMALL = PinholeCamera(320, 240, 262.5, 262.5, 159.5, 119.5)
WIDTH = (0.55, 0.7, 1.8, 2.5)


def rooms(gap=(50, 68), thickness=4):
    """Free and standing cells of two rooms of 4 m, parted by a wall with a gap, and their grid."""
    standing = np.zeros((120, 164), dtype=bool)
    standing[[0, -1]] = standing[:, [0, -1]] = True
    standing[:, 80 : 80 + thickness] = True
    standing[gap[0] : gap[1], 80 : 80 + thickness] = False
    grid = OccupancyGrid(np.where(standing, 0.9, 0.1).astype(np.float32), 0.05, (-1.0, 2.0))
    return ~standing, standing, grid


@pytest.mark.parametrize("thickness", [1, 4, 8])
def test_a_door_is_one_narrow_place_as_wide_as_it_is(thickness):
    ((jambs, p),) = gaps_of_map(*rooms(thickness=thickness), WIDTH)
    assert np.linalg.norm(jambs[1] - jambs[0]) == pytest.approx(
        0.9, abs=0.11
    )  # a cell on either side
    assert jambs[:, 1] + jambs[::-1, 1] == pytest.approx(2 * (2.0 + 59 * 0.05), abs=0.01)
    assert 3.0 <= jambs[0, 0] <= 3.0 + thickness * 0.05
    assert p > 0.9


@pytest.mark.parametrize(("gap", "count"), [((50, 58), 0), ((40, 100), 0), ((50, 62), 1)])
def test_holes_and_open_walls_are_none(gap, count):
    assert len(list(gaps_of_map(*rooms(gap), WIDTH))) == count


def test_two_legs_are_no_jambs_and_a_corridor_is_narrow_nowhere():
    _, standing, grid = rooms()
    standing[:, 80:84] = False
    standing[50, 80] = standing[68, 80] = True
    assert not any(p > 0.1 for _, p in gaps_of_map(~standing, standing, grid, WIDTH))
    standing[:] = False
    standing[[50, 70]] = True
    assert not list(gaps_of_map(~standing, standing, grid, WIDTH))


def test_what_nothing_is_known_of_is_no_way():
    free, standing, grid = rooms()
    free[:, 84:] = False
    assert not any(p > 0 for _, p in gaps_of_map(free, standing, grid, WIDTH))


def test_runs_and_thickness_are_measured_over_small_holes():
    standing = np.zeros((100, 100), dtype=bool)
    standing[20:60, 40] = True
    standing[30:33, 40] = False
    standing[70, 30:36] = True
    grid = OccupancyGrid(np.zeros((100, 100), np.float32), 0.05, (0.0, 0.0))
    jambs = (np.array([[40, 59], [33, 70]]) + 0.5) * 0.05
    assert runs_m(standing, jambs * [0, 1] + [2.0, 0.0], grid) == pytest.approx((2.0, 0.0))
    turned = np.array([jambs[0], jambs[0] + [1.0, 0.0]])
    assert runs_m(standing, turned, grid) == pytest.approx((2.0, 0.0))
    bench = np.array([jambs[1], jambs[1] + [1.0, 0.0]])
    assert runs_m(standing, bench, grid)[0] == pytest.approx(0.3)
    assert thickness_m(standing, bench, grid)[0] == pytest.approx(0.05)
    assert thickness_m(standing, turned, grid) == pytest.approx((2.0, 0.0))
    slanting = np.array([jambs[0], jambs[0] + [1.0, 1.0]])
    assert runs_m(standing, slanting, grid)[0] < 0.5


def looked_at(boxes, x, y, facing):
    """A view from a place among boxes, along the x axis (1) or against it (-1)."""
    moved = []
    for box in boxes:
        corners = np.array([box.low, box.high]) - (x, y, 0.0)
        low, high = np.sort(corners * (facing, facing, 1.0), axis=0)
        moved.append(depth.Box(tuple(low), tuple(high)))
    view = depth.view_of([depth.FLOOR, *moved], 1.2, 20.0, np.random.default_rng(0), SMALL)
    return replace(view, T_map_base=T_from_xy_yaw(x, y, 0.0 if facing > 0 else np.pi))


WALL = depth.Box((3.0, 0.45, 0.0), (3.2, 5.0, 2.5))


def from_depth(beside, poses, wall=(WALL,)):
    """Doorways of depth views of a wall across two rooms; `beside` is what ends at the gap."""
    ends = [depth.Box((x, -5.0, 0.0), (x + 0.1, 5.0, 2.5)) for x in (-0.6, 6.6)]
    merger, grid = DoorwayMerger(), GridBuilder()
    for pose in poses:
        view = looked_at([*wall, *beside, *ends], *pose)
        merger.add(view, ())
        insert_view(grid, view)
    return merger.doorways(grid.grid())


PLACES = [(x, y, facing) for x, facing in ((1.2, 1), (5.0, -1)) for y in (-1.2, 0.0, 1.2)]


def test_views_that_show_one_jamb_each_make_a_doorway_together():
    wall = depth.Box((3.0, -5.0, 0.0), (3.2, -0.45, 2.5))
    (found,) = from_depth([wall], PLACES)
    assert (found.x, found.y) == pytest.approx((3.1, 0.0), abs=0.12)
    assert found.width == pytest.approx(0.9, abs=0.08)
    assert not from_depth([wall], [p for p in PLACES if p[1] > 1])


def test_a_gap_beside_a_low_counter_is_no_doorway():
    assert not from_depth([depth.Box((3.0, -5.0, 0.0), (3.6, -0.45, 0.9))], PLACES)


def test_a_narrowing_between_cabinets_is_no_doorway():
    standing = [depth.Box((3.0, y, 0.0), (3.2, y + 0.7, 1.5)) for y in (-1.15, 0.45)]
    walls = [depth.Box((3.0, y, 0.0), (3.2, y + 3.85, 0.9)) for y in (-5.0, 1.15)]
    assert not from_depth([*standing, *walls], PLACES, [])
    assert from_depth([*standing, *(replace_top(w) for w in walls)], PLACES, [])


def replace_top(box):
    """The same box as high as a wall."""
    return depth.Box(box.low, (*box.high[:2], 2.5))


def test_an_aisle_between_deep_cabinets_is_no_doorway():
    deep = [depth.Box((3.0, y, 0.0), (4.1, y + 4.55, 2.5)) for y in (-5.0, 0.45)]
    assert not from_depth(deep, PLACES, [])


def test_widths_are_the_ontologys():
    gate = SimpleNamespace(parameters={"width_m": Trapezoid(2.5, 2.8, 3.2, 3.5)})
    width = passage_width(SimpleNamespace(features={"PassAbility": gate}))
    assert not list(gaps_of_map(*rooms(), width))
    assert len(list(gaps_of_map(*rooms((30, 88)), width))) == 1
    assert passage_width(SimpleNamespace(features={})) == WIDTH
