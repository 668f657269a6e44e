"""Open plans: one room is divided where what stands in its parts tells of two purposes."""

import math

import numpy as np
import pytest

from afkb.flow import Doorway, OccupancyGrid
from afkb_mapping.doorways.doorway import DoorwayShape
from afkb_mapping.doorways.judge import DoorwayJudge
from afkb_mapping.rooms.graph import connections, is_doorway
from afkb_mapping.rooms.rooms import divide_by_purpose, segment_rooms
from afkb_mapping.segmentation.open_plan import bayes_factor
from afkb_mapping.upright_cells import UprightCells

PRIOR = {"Kitchen": 0.5, "LivingRoom": 0.5}
KITCHEN, LIVING_ROOM = {"Kitchen": 0.9, "LivingRoom": 0.1}, {"Kitchen": 0.1, "LivingRoom": 0.9}
STOVE, SOFA = (60, 20), (60, 140)


def test_parts_that_tell_nothing_are_as_well_one_room_as_two():
    assert bayes_factor(PRIOR, KITCHEN, PRIOR) == pytest.approx(1.0)
    assert bayes_factor(KITCHEN, KITCHEN, PRIOR) == pytest.approx(1 / 1.64)
    assert bayes_factor(KITCHEN, LIVING_ROOM, PRIOR) == pytest.approx(1 / 0.36)
    assert bayes_factor(
        {"Kitchen": 1, "LivingRoom": 0}, {"Kitchen": 0, "LivingRoom": 1}, PRIOR
    ) == (math.inf)


def open_plan():
    """8 m by 6 m, with stubs of wall in the middle of both long walls."""
    probability = np.full((120, 160), 0.1, np.float32)
    probability[[0, -1]], probability[:, [0, -1]] = 0.9, 0.9
    probability[:14, 78:82], probability[-14:, 78:82] = 0.9, 0.9
    return OccupancyGrid(probability, 0.05, (0.0, 0.0))


def told(part, sofa_is_sure=True):
    """What the stove and the sofa tell of a part of it."""
    if part[STOVE]:
        return {"Kitchen": 0.95, "LivingRoom": 0.05} if not part[SOFA] else PRIOR
    return (
        ({"Kitchen": 0.05, "LivingRoom": 0.95} if sofa_is_sure else PRIOR) if part[SOFA] else None
    )


def test_an_open_plan_is_divided_between_its_purposes_along_the_stubs():
    grid = open_plan()
    whole = segment_rooms(grid)
    assert len(whole.rooms) == 1
    found = divide_by_purpose(whole, grid, told, PRIOR)
    assert len(found.rooms) == 2
    assert found.labels[STOVE] != found.labels[SOFA]
    assert [room.area for room in found.rooms] == pytest.approx([23.5, 23.5], rel=0.03)
    assert found.connected == ((1, 2),)


def test_an_open_plan_stays_whole_where_one_part_tells_nothing():
    grid = open_plan()
    whole = segment_rooms(grid)
    found = divide_by_purpose(whole, grid, lambda part: told(part, sofa_is_sure=False), PRIOR)
    assert len(found.rooms) == 1


def test_an_opening_as_wide_as_a_hall_connects_rooms_but_is_no_doorway():
    grid = open_plan()
    judge = DoorwayJudge(UprightCells(), grid)
    assert not is_doorway(DoorwayShape(4.0, 3.0, 0.0, 4.6, (1, 2)), judge)
    found = divide_by_purpose(segment_rooms(grid), grid, told, PRIOR)
    assert connections(found, ()) == {"room-1": ("room-2",), "room-2": ("room-1",)}
    seen = Doorway("doorway-1", 0, 0, 0, 0.9, ("room-2", "room-3"))
    assert connections(found, [seen])["room-2"] == ("room-1", "room-3")


def test_a_gap_of_which_no_view_tells_the_height_may_be_a_doorway():
    probability = np.full((120, 160), 0.1, np.float32)
    probability[[0, -1]], probability[:, [0, -1]] = 0.9, 0.9
    probability[:50, 78:82], probability[68:, 78:82] = 0.9, 0.9
    grid = OccupancyGrid(probability, 0.05, (0.0, 0.0))
    (shape,) = segment_rooms(grid).doorways
    assert is_doorway(shape, DoorwayJudge(UprightCells(), grid))
