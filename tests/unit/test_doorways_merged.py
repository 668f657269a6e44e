"""Doorways of several views: merged, held against what depth and the grid say, and placed."""

from dataclasses import replace

import numpy as np
import pytest

import laser_samples as laser
from afkb.flow import OccupancyGrid
from afkb_doorways.detector import DoorwayDetector
from afkb_mapping.doorways.detour import room_to_room
from afkb_mapping.doorways.doorway import DoorwayShape
from afkb_mapping.doorways.merger import DoorwayMerger, SeenDoorway
from afkb_mapping.doorways.united import united
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.grid.input import insert_view
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.panorama import Panorama
from afkb_mapping.upright_cells import UprightCells

POSES = [(3, 4, 0.0), (3.5, 3, 0.6), (2, 3, 0.2), (7, 3, -2.0), (7, 4.5, 2.8), (8, 2, 3.0)]


def merged(poses, segments=laser.FLAT, at_least=0.2):
    merger, grid, detector = DoorwayMerger(), GridBuilder(), DoorwayDetector()
    for i, pose in enumerate(poses):
        view = laser.view(segments, pose, pose, i, np.random.default_rng(i), beams=720)
        view = replace(view, T_map_base=T_from_xy_yaw(*pose))
        merger.add(view, detector.detect(view, ()))
        insert_view(grid, view)
    return merger.doorways(grid.grid(), at_least)


def test_views_from_both_rooms_make_one_doorway():
    (found,) = merged(POSES)
    assert (found.x, found.y) == pytest.approx((5, 3.95), abs=0.05)
    assert found.width == pytest.approx(0.9, abs=0.05)
    assert found.views == len(POSES)


def test_more_places_seen_from_make_it_likelier_and_the_same_place_does_not():
    (once,) = merged(POSES[:1])
    (again,) = merged(POSES[:1] * 3)
    (from_all,) = merged(POSES)
    assert again.probability == pytest.approx(once.probability, abs=0.05)
    assert from_all.probability > once.probability + 0.1


def test_a_gap_behind_a_cabinet_that_one_walks_round_is_none():
    island = [
        [[2, 2], [3.2, 2]],
        [[3.2, 2], [3.2, 0.8]],
        [[3.2, 0.8], [2, 0.8]],
        [[2, 0.8], [2, 2]],
    ]
    hall = [[[0, 0], [9, 0]], [[9, 0], [9, 6]], [[9, 6], [0, 6]], [[0, 6], [0, 0]]]
    around = [(1, 0.4, 0.0), (1, 3, -0.5), (4.5, 0.4, 3.0), (4.5, 3, -2.5), (2.6, 3.5, -1.5)]
    assert not merged(around, np.array(hall + island, dtype=float))


def grid_of(free):
    return OccupancyGrid(np.where(free, 0.1, 0.9).astype(np.float32), 0.05, (0.0, 0.0))


def test_the_way_round_tells_a_door_from_furniture():
    free = np.ones((120, 160), dtype=bool)
    free[:, 80:83] = False
    free[50:68, 80:83] = True
    jambs = np.array([[4.07, 2.5], [4.07, 3.4]])
    assert room_to_room(jambs, free, grid_of(free)) == pytest.approx(1.0)
    free[:, 80:83] = True
    free[40:50, 80:83] = free[68:78, 80:83] = False
    assert room_to_room(jambs, free, grid_of(free)) < 0.3


def seen_at(low_m, tall_m, waist_m):
    """A panorama in which something low and something tall stand, in all directions."""
    bearings = (np.arange(720) + 0.5) * (np.pi / 360) - np.pi
    low, waist, tall = (np.full(720, r) for r in (low_m, waist_m, tall_m))
    nothing = np.full(720, np.nan)
    return Panorama(np.zeros(2), bearings, low, waist, tall, nothing, np.fmin(low, tall), nothing)


def test_what_one_looks_over_is_low():
    cells = UprightCells()
    for _ in range(2):
        cells.add(seen_at(1.0, 3.0, waist_m=1.0))
    assert cells.tall(np.array([[1.0, 0.0]]), 0.1) == 0
    assert cells.tall(np.array([[3.0, 0.0]]), 0.1) == 1
    assert np.isnan(cells.tall(np.array([[2.0, 0.0]]), 0.1))
    assert cells.stands_on(np.array([[1.0, 0.0], [2.0, 0.0]])) == 0.5


@pytest.mark.parametrize(("waist_m", "knee"), [(1.0, 0), (2.5, 1)])
def test_beds_are_told_from_cabinets(waist_m, knee):
    cells = UprightCells()
    cells.add(seen_at(1.0, 3.0, waist_m))
    assert cells.knee_high(np.array([[1.0, 0.0]]), 0.1) == knee


def test_united_with_those_of_the_grid_each_place_is_one():
    shape = DoorwayShape(4.1, 2.0, 0.3, 1.4, (1, 2))
    alone = DoorwayShape(9.0, 9.0, 0.0, 1.0, (2, 3))
    door = SeenDoorway(4.0, 2.2, 3.1, 0.9, 0.9, 4, float("nan"))
    other = SeenDoorway(1.0, 1.0, 0.0, 0.8, 0.8, 3, float("nan"))
    first, second, third = united([shape, alone], [door, other], lambda x, y: "room-1")
    assert (first.x, first.width, first.rooms) == (4.0, 0.9, ("room-1", "room-2"))
    assert np.cos(first.yaw - shape.yaw) > 0.9
    assert (second.x, second.rooms) == (9.0, ("room-2", "room-3"))
    assert (third.x, third.rooms) == (1.0, ("room-1",))
