"""Places: one for what is near and seen alike, another beyond a doorway."""

import numpy as np
import pytest

from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.ids import Ids
from afkb_mapping.places import Places
from mapping_samples import view


@pytest.fixture
def two_rooms() -> GridBuilder:
    """A wall along x = 1.5 with a doorway of 0.8 m around y = 0."""
    grid = GridBuilder()
    beyond = np.concatenate([np.arange(0.4, 3.0, 0.02), np.arange(-3.0, -0.4, 0.02)])
    wall = np.column_stack([np.full(beyond.size, 1.5), beyond])
    for x in (0.0, 3.0):
        grid.insert_depth_obstacles(wall, np.array([x, 0.0]))
    return grid


def visit(places, grid, x, y, entities):
    return places.visit(view(x=x, y=y), dict.fromkeys(entities), grid).id


def test_what_is_near_is_one_place_whatever_is_seen(two_rooms):
    places = Places(Ids())
    first = visit(places, two_rooms, 0.0, 0.0, ["table"])
    assert visit(places, two_rooms, 0.3, 0.8, ["bed"]) == first


def test_beyond_a_doorway_is_another_place_and_the_way_leads_there(two_rooms):
    places = Places(Ids())
    first = visit(places, two_rooms, 0.6, 0.0, ["table"])
    second = visit(places, two_rooms, 2.4, 0.0, ["table"])
    assert second != first
    assert list(places.ways) == [(first, second)]
    assert places.ways[first, second] == pytest.approx(1.8)
    assert visit(places, two_rooms, 0.6, 0.1, ["table"]) == first


def test_standing_in_a_doorway_is_no_place_of_its_own(two_rooms):
    places = Places(Ids())
    first = visit(places, two_rooms, 0.6, 0.0, ["table"])
    assert visit(places, two_rooms, 1.5, 0.0, ["bed"]) == first


def test_behind_a_wall_is_another_place_even_with_nothing_in_view(two_rooms):
    places = Places(Ids())
    first = visit(places, two_rooms, 0.0, 2.0, ["table"])
    assert visit(places, two_rooms, 2.9, 2.0, []) != first


def test_where_nothing_affords_anything_places_are_far_apart():
    places, grid = Places(Ids()), GridBuilder()
    ids = [visit(places, grid, x, 0.0, []) for x in np.arange(0.0, 13.0, 1.0)]
    assert len(dict.fromkeys(ids)) == 3
