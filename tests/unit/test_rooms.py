"""Rooms and doorways of occupancy grids."""

import math
from dataclasses import replace

import numpy as np
import pytest

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways.merger import SeenDoorway
from afkb_mapping.rooms.rooms import segment_rooms

RESOLUTION = 0.05


def blank(width, depth):
    """A walled rectangle of free space, m."""
    probability = np.full((round(depth / RESOLUTION), round(width / RESOLUTION)), 0.1, np.float32)
    probability[:2], probability[-2:], probability[:, :2], probability[:, -2:] = (0.9,) * 4
    return probability


def fill(probability, x0, y0, x1, y1, value):
    rows, cols = np.round(np.array([y0, y1, x0, x1]) / RESOLUTION).astype(int).reshape(2, 2)
    probability[slice(*rows), slice(*cols)] = value


def segmented(probability, origin=(0.0, 0.0)):
    grid = OccupancyGrid(probability, RESOLUTION, origin)
    return grid, segment_rooms(grid)


def two_rooms(door=(2.0, 2.9)):
    probability = blank(9, 5)
    fill(probability, 5.0, 0, 5.1, door[0], 0.9)
    fill(probability, 5.0, door[1], 5.1, 5, 0.9)
    return probability


def test_a_wall_with_a_door_parts_two_rooms():
    _, found = segmented(two_rooms(), origin=(-3.0, 7.0))
    assert len(found.rooms) == 2
    assert found.rooms[0].area == pytest.approx(4.9 * 4.8, rel=0.05)
    (door,) = found.doorways
    assert (door.x, door.y) == pytest.approx((5.05 - 3, 2.45 + 7), abs=0.15)
    assert door.width == pytest.approx(0.9, abs=0.11)
    assert abs(math.cos(door.yaw)) > 0.9
    assert door.labels == (1, 2)
    assert math.cos(door.yaw) > 0


def test_a_room_has_its_point_inside_and_its_outline_around_it():
    grid, found = segmented(two_rooms(), origin=(-3.0, 7.0))
    for room in found.rooms:
        x, y = room.inside_xy
        col, row = np.floor((np.array([x, y]) - grid.origin_xy) / RESOLUTION).astype(int)
        assert found.labels[row, col] == room.label
        low, high = room.polygon_xy.min(axis=0), room.polygon_xy.max(axis=0)
        assert (low < [x, y]).all()
        assert (high > [x, y]).all()


def test_furniture_does_not_part_a_room():
    probability = blank(6, 5)
    fill(probability, 2, 1.5, 3.6, 2.4, 0.9)
    for x in (4.2, 4.8):
        for y in (2.0, 2.6):
            fill(probability, x, y, x + 0.05, y + 0.05, 0.9)
    _, found = segmented(probability)
    assert len(found.rooms) == 1
    assert found.doorways == ()
    assert found.rooms[0].area == pytest.approx(5.8 * 4.8, rel=0.03)


def test_an_opening_between_long_walls_parts_rooms_wide_as_it_is():
    _, found = segmented(two_rooms(door=(1.0, 3.4)))
    assert len(found.rooms) == 2
    assert found.rooms[0].area == pytest.approx(4.9 * 4.8, rel=0.03)


def test_stubs_of_wall_do_not_part_a_room():
    _, found = segmented(two_rooms(door=(0.5, 4.6)))
    assert len(found.rooms) == 1


def test_a_wide_opening_parts_rooms_where_views_have_shown_a_doorway():
    seen = SeenDoorway(5.05, 2.55, 0.0, 4.1, 0.9, 4, math.nan)
    grid = OccupancyGrid(two_rooms(door=(0.5, 4.6)), RESOLUTION, (0.0, 0.0))
    assert len(segment_rooms(grid, [seen]).rooms) == 2
    doubtful = replace(seen, probability=0.1)
    assert len(segment_rooms(grid, [doubtful]).rooms) == 1


def test_a_corridor_that_opens_into_a_hall_is_a_room_of_its_own():
    probability = np.full((120, 220), 0.9, np.float32)
    fill(probability, 0.1, 0.1, 5, 5.9, 0.1)
    fill(probability, 5, 2.4, 10.9, 3.6, 0.1)
    _, found = segmented(probability)
    assert [room.area for room in found.rooms] == pytest.approx([4.9 * 5.8, 5.9 * 1.2], rel=0.05)


def test_furniture_along_the_walls_does_not_part_a_room():
    probability = blank(8, 5)
    fill(probability, 3.5, 0.1, 5.0, 0.7, 0.9)
    fill(probability, 3.5, 4.4, 5.5, 4.9, 0.9)
    _, found = segmented(probability)
    assert len(found.rooms) == 1


def test_ragged_free_space_with_unknown_holes_is_one_room():
    rng = np.random.default_rng(0)
    probability = blank(4, 4)
    probability[rng.random(probability.shape) < 0.15] = np.nan
    _, found = segmented(probability)
    assert len(found.rooms) == 1
    assert found.rooms[0].area == pytest.approx(3.8**2, rel=0.1)


def test_beams_through_a_window_are_no_room():
    probability = np.full((120, 160), np.nan, np.float32)
    probability[20:100, 20:100] = blank(4, 4)
    probability[60, 98:160] = 0.1
    _, found = segmented(probability)
    assert len(found.rooms) == 1
    assert found.rooms[0].polygon_xy[:, 0].max() < 5.2


def test_a_closet_belongs_to_the_room_it_opens_to():
    probability = blank(6, 5)
    fill(probability, 0, 3.6, 1.2, 3.7, 0.9)
    fill(probability, 1.2, 3.6, 1.3, 4.0, 0.9)
    fill(probability, 1.2, 4.6, 1.3, 5, 0.9)
    _, found = segmented(probability)
    assert len(found.rooms) == 1


def test_a_bathroom_behind_a_door_that_was_seen_is_a_room():
    probability = blank(6, 5)
    fill(probability, 0, 3.6, 1.2, 3.7, 0.9)
    fill(probability, 1.2, 3.6, 1.3, 3.9, 0.9)
    fill(probability, 1.2, 4.6, 1.3, 5, 0.9)
    door = SeenDoorway(1.25, 4.25, 0.0, 0.7, 0.9, 4, math.nan)
    found = segment_rooms(OccupancyGrid(probability, RESOLUTION, (0.0, 0.0)), [door])
    assert [room.area for room in found.rooms] == pytest.approx([26.6, 1.3], abs=0.4)


def test_a_counter_that_a_doorway_hangs_in_is_no_furniture():
    probability = blank(8, 5)
    fill(probability, 4, 0.1, 4.1, 0.8, 0.9)
    fill(probability, 4, 1.8, 4.6, 4.0, 0.9)
    assert len(segmented(probability)[1].rooms) == 1
    door = SeenDoorway(4.05, 1.3, 0.0, 1.0, 0.9, 4, math.nan)
    found = segment_rooms(OccupancyGrid(probability, RESOLUTION, (0.0, 0.0)), [door])
    assert len(found.rooms) == 2


@pytest.mark.parametrize("width", [1.2, 1.6, 2.0])
def test_a_corridor_is_not_cut_between_doors_that_face_each_other(width):
    probability = blank(12, 8)
    for y in (3.0, 3.1 + width):
        fill(probability, 0, y, 12, y + 0.1, 0.9)
        for x in (5.0, 6.05):
            fill(probability, x, y, x + 0.9, y + 0.1, 0.1)
    for low, high in ((0, 3), (3.2 + width, 8)):
        fill(probability, 5.93, low, 6.02, high, 0.9)
    _, found = segmented(probability)
    assert len(found.rooms) == 5


def test_a_corridor_is_told_from_the_rooms_along_it():
    probability = blank(12, 6)
    fill(probability, 0, 4.2, 12, 4.3, 0.9)
    for x in (4.0, 8.0):
        fill(probability, x, 0, x + 0.1, 4.2, 0.9)
    for x in (1.5, 5.5, 9.5):
        fill(probability, x, 4.2, x + 0.9, 4.3, 0.1)
    _, found = segmented(probability)
    assert len(found.rooms) == 4
    assert len(found.doorways) == 3


def test_where_only_things_were_seen_they_are_in_one_room():
    probability = np.full((80, 80), np.nan, np.float32)
    fill(probability, 0.5, 0.5, 0.8, 3.0, 0.9)
    fill(probability, 2.2, 0.8, 2.9, 2.6, 0.9)
    fill(probability, 1.2, 1.0, 1.5, 1.4, 0.1)
    _, found = segmented(probability)
    (room,) = found.rooms
    assert 3 < room.area < 7
    assert found.doorways == ()


def test_an_unknown_grid_has_no_rooms():
    _, found = segmented(np.full((5, 5), np.nan, np.float32))
    assert found.rooms == ()
    assert not found.labels.any()
