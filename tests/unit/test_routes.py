"""Routes keep clear of what stands there by the robot's radius, and errors say what would help."""

from itertools import pairwise

import numpy as np
import pytest
from scipy import ndimage

from afkb.errors import MapError, RouteError
from afkb.finding import Node, RoomNode, Surroundings
from afkb.flow import OccupancyGrid
from afkb.knowledge import AfNet
from afkb.store.stored_grid import StoredGrid, read_grid
from afkb_mapping.routes.ends import Kind, end_of
from afkb_mapping.routes.planner import Planner
from afkb_mapping.routes.route_map import MappedRoom, RouteMap, Spot, Thing
from afkb_mapping.routes.search import search
from afkb_mapping.routes.straight import cost_of, shortened

CELL_M = 0.05
FREE, WALL = 0.05, 0.97


def square(x: float, y: float, half: float) -> np.ndarray:
    return np.array(
        [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]
    )


def thing(id_, x, y, half=0.2, kind="ObservedEntity", existence=0.9, room="room-2", **belief):
    return Thing(
        id_, kind, np.array([x, y]), square(x, y, half), existence, 1.0, belief, room, None
    )


def two_rooms(gap_m: float = 0.8, things=(), drawn=()) -> RouteMap:
    """Two rooms of 4 m x 4 m side by side; the wall at x = 4 has a gap around y = 2."""
    p = np.full((80, 160), FREE, np.float32)
    p[[0, -1], :] = p[:, [0, -1]] = WALL
    p[:, 80] = WALL
    half = round(gap_m / CELL_M / 2)
    p[40 - half : 40 + half, 80] = FREE
    for x, y, extent, value in drawn:
        r, c, n = int(y / CELL_M), int(x / CELL_M), round(extent / CELL_M)
        p[max(r - n, 0) : r + n, max(c - n, 0) : c + n] = value
    rooms = {
        "room-1": MappedRoom("room-1", np.array([2.0, 2.0]), {"Hallway": 0.9}, True),
        "room-2": MappedRoom("room-2", np.array([6.0, 2.0]), {"Kitchen": 0.8}, True),
    }
    spots = {
        "place-1": Spot("place-1", np.array([1.0, 1.0]), "room-1"),
        "place-2": Spot("place-2", np.array([6.0, 1.0]), "room-2"),
    }
    doors = {"doorway-1": Spot("doorway-1", np.array([4.025, 2.0]), None, gap_m, 0.0)}
    stored = StoredGrid(OccupancyGrid(p, CELL_M, (0.0, 0.0)), 0.196, 0.65)
    return RouteMap(
        stored, {t.id: t for t in things}, spots, doors, rooms, surroundings(things, rooms)
    )


def surroundings(things, rooms) -> Surroundings:
    nodes = [
        Node(t.id, t.kind, *t.xy, 0.8, t.existence, t.belief, t.room, viewpoints=1) for t in things
    ]
    return Surroundings(
        {n.id: n for n in nodes},
        {r.id: RoomNode(r.id, *r.xy, r.belief, 1) for r in rooms.values()},
    )


@pytest.fixture(scope="module")
def kb() -> AfNet:
    return AfNet.load()


def route(known, kb, start, goal, radius=0.2):
    planner = Planner.of(known, radius)
    return planner.route_round(end_of(start, known, kb), end_of(goal, known, kb))


@pytest.mark.parametrize("radius", [0.0, 0.15, 0.3])
def test_a_route_keeps_clear_by_the_radius_and_is_no_longer_than_it_must(kb, radius) -> None:
    known = two_rooms()
    found = route(known, kb, "0.6,3.4", "7.4, 3.4", radius)
    blocked = known.grid.grid.probability > 0.65
    clearance = (ndimage.distance_transform_edt(~blocked) - 0.5) * CELL_M
    line = np.concatenate([np.linspace(a, b, 200) for a, b in pairwise(found.path)])
    cells = np.floor(line / CELL_M).astype(int)
    assert clearance[cells[:, 1], cells[:, 0]].min() >= radius - 1e-6
    tight = 2 * np.hypot(3.4, 1.0 + radius)
    assert tight - 0.01 <= found.length <= 1.03 * tight
    assert np.allclose(found.path[0], [0.6, 3.4]) and np.allclose(found.path[-1], [7.4, 3.4])
    assert found.doorways == ("doorway-1",) and found.rooms == ("room-1", "room-2")


@pytest.mark.parametrize("seed", range(8))
def test_among_scattered_things_a_route_keeps_clear_too(kb, seed) -> None:
    rng = np.random.default_rng(seed)
    drawn = [(*rng.uniform(0.5, (7.5, 3.5)), 0.15, WALL) for _ in range(14)]
    known = two_rooms(drawn=drawn)
    planner = Planner.of(known, 0.1)
    start = planner.standing.start(known.places["place-1"], "--from")
    reached = np.argwhere(np.isfinite(planner.paths.costs(start)))
    for cell in reached[rng.integers(len(reached), size=6)]:
        path = planner.paths.path(start, (int(cell[0]), int(cell[1])))
        line = np.concatenate([path, *(np.linspace(a, b, 300) for a, b in pairwise(path))])
        cells = np.floor(line / CELL_M).astype(int)
        # A point on the border of two cells may be counted to the other one.
        assert planner.where.clearance_m[cells[:, 1], cells[:, 0]].min() >= 0.1 - CELL_M
        assert np.allclose(planner.where.middles(cell[None])[0], path[-1])


def test_a_step_that_cannot_be_driven_opens_no_short_cut(kb) -> None:
    where = Planner.of(two_rooms(), 0.1).where
    beside_the_wall = [3.95, 1.9]
    round_about = np.array([[1.0, 0.5], beside_the_wall, [4.0, 2.0], [4.1, 2.0], [7.0, 0.5]])
    assert not np.isfinite(cost_of(where, np.array([3.95, 0.5]), np.array(beside_the_wall)))
    path = shortened(where, np.insert(round_about, 1, [3.95, 0.5], axis=0))
    across = [
        a + (4.02 - a[0]) / (b[0] - a[0]) * (b - a) for a, b in pairwise(path) if a[0] < 4.02 < b[0]
    ]
    assert all(1.6 < y < 2.4 for _, y in across) and across


def test_rooms_by_kind_nodes_and_points_name_ends_and_the_nodes_between(kb) -> None:
    found = route(two_rooms(), kb, "hallway", "Kitchen")
    assert found.nodes == ("room-1", "place-1", "place-2", "room-2")
    assert np.hypot(*(found.path[-1] - [6.0, 1.0])) < 0.05


def test_who_is_too_wide_hears_where_it_is_narrow_and_who_would_pass(kb) -> None:
    with pytest.raises(RouteError, match=r"too narrow at 4\.\d+,\d\.\d+ \(doorway-1\)") as told:
        route(two_rooms(0.6), kb, "room-1", "room-2", 0.4)
    radius = float(str(told.value).split("--robot-radius ")[1].split()[0])
    assert 0.2 < radius < 0.4
    assert route(two_rooms(0.6), kb, "room-1", "room-2", radius).length > 4


@pytest.mark.parametrize(
    ("start", "goal", "said"),
    [
        ("4.02,0.5", "room-2", "--from: 4.02,0.5 is in an obstacle"),
        ("place-1", "20,20", "--to: 20,20 is not in the map"),
        ("plaice-1", "room-2", "did you mean place-1"),
        ("Bathroom", "room-2", "no room of the map is likely one"),
        ("mug", "room-2", "a route starts at a point, a node or a room"),
    ],
)
def test_what_names_no_end_is_told_in_a_line(kb, start, goal, said) -> None:
    with pytest.raises(RouteError) as told:
        route(two_rooms(), kb, start, goal)
    assert said in str(told.value) and "\n" not in str(told.value)


def test_a_closed_wall_leaves_no_way_for_anyone(kb) -> None:
    with pytest.raises(RouteError, match="no way to room-2: walls"):
        route(two_rooms(0.0), kb, "room-1", "room-2")


def test_what_is_doubtful_is_gone_round_and_what_is_expected_only_crossed_if_it_must(kb) -> None:
    straight = route(two_rooms(), kb, "0.6,2.0", "3.4,2.0").length
    doubtful = route(two_rooms(drawn=[(2.0, 2.0, 0.3, 0.3)]), kb, "0.6,2.0", "3.4,2.0")
    assert straight < doubtful.length < 1.3 * straight
    table = thing("predicted-1", 4.0, 2.0, 0.5, "DualPrediction", 0.7, "room-1")
    over = route(two_rooms(things=[table], drawn=[(4.0, 2.0, 0.4, 0.7)]), kb, "room-1", "room-2")
    assert over.through == ("predicted-1",)


def test_one_stands_before_a_thing_on_the_side_from_which_it_is_seen(kb) -> None:
    cabinet = thing("thing-1", 4.3, 0.5, 0.2)
    known = two_rooms(things=[cabinet], drawn=[(4.3, 0.5, 0.2, WALL)])
    end = route(known, kb, "place-1", "thing-1").path[-1]
    assert end[0] > 4.1 and np.hypot(*(end - cabinet.xy)) < 1.0


def test_a_search_goes_where_a_thing_is_likely_and_says_what_it_costs(kb) -> None:
    mugs = [
        thing("thing-1", 7.0, 3.0, Mug=0.6),
        thing("thing-2", 3.0, 3.0, room="room-1", Mug=0.2),
        thing("thing-3", 7.0, 2.8, Mug=0.1),
    ]
    known = two_rooms(things=mugs)
    found = search(Planner.of(known, 0.2), kb, end_of("place-1", known, kb), Kind("Mug"))
    looked = [tuple(c.node.id for c in place.found) for place in found.places]
    assert ("thing-1", "thing-3") in looked and ("thing-2",) in looked
    assert found.known_m < found.order.expected_m <= min(found.nearest_m, found.probable_m)
    assert found.metres[-1] == pytest.approx(found.route.length, abs=1e-6)
    hits = [place.probability for place in found.places]
    assert found.nowhere == pytest.approx(float(np.prod(1 - np.array(hits))))
    assert found.places[looked.index(("thing-1", "thing-3"))].probability == pytest.approx(
        1 - (1 - 0.54) * (1 - 0.09)
    )


def test_a_search_for_what_is_nowhere_says_so(kb) -> None:
    known = two_rooms()
    with pytest.raises(RouteError, match="nothing in this map"):
        search(Planner.of(known, 0.2), kb, end_of("place-1", known, kb), Kind("Piano"))


def test_a_grid_that_is_none_is_told_with_its_file(tmp_path) -> None:
    with pytest.raises(MapError, match=r"occupancy\.yaml"):
        read_grid(tmp_path)
    (tmp_path / "occupancy.yaml").write_text("image: a.pgm\n")
    (tmp_path / "a.pgm").write_bytes(b"P5\n3 3\n255\n123")
    with pytest.raises(MapError, match="no grid that can be read"):
        read_grid(tmp_path)
