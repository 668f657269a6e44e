"""Self-localisation with a laser in a drawn flat: found, in doubt, or lost."""

import math
from dataclasses import replace

import numpy as np
import pytest

import laser_samples as samples
from afkb.errors import MapError
from afkb.flow import PinholeCamera
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.localisation.bands import FREE, STANDS, UNKNOWN, BandBuilder, HeightBands
from afkb_mapping.localisation.localiser import DEPTH, LASER, Localiser
from afkb_mapping.localisation.readings import joined, readings_of
from afkb_mapping.localisation.sensor_model import CLEAR, HIT, INDEPENDENT_DEPTH, LASER_ROW, UNSEEN
from afkb_mapping.localisation.slabs import SLAB_M, SLABS
from depth_samples import FLOOR, Box, view_of

MAPPED_FROM = [(2, 2, 0), (2.5, 2.5, 1), (5, 2, 0), (7, 2, 2), (7, 4, 0), (3, 3, 2)]
PER_READING = ("origin", "bearing", "range_m", "row", "kind")
ASKED_FROM = [(2.3, 1.7, 0.7), (7.3, 2.2, -2.0)]


def view_at(pose, range_max=12.0):
    view = samples.view(samples.FLAT, pose, pose, 0, beams=360, range_max=range_max)
    return replace(view, T_map_base=T_from_xy_yaw(*pose))


@pytest.fixture(scope="module")
def bands() -> HeightBands:
    builder = BandBuilder()
    for pose in MAPPED_FROM:
        builder.add(view_at(pose))
    return builder.bands()


@pytest.fixture(scope="module")
def localiser(bands) -> Localiser:
    return Localiser(bands)


@pytest.mark.parametrize("pose", ASKED_FROM)
def test_a_scan_from_a_new_pose_is_placed_to_a_few_centimetres(localiser, pose):
    found = localiser.locate([readings_of(view_at(pose), np.eye(4))])
    assert not found.lost
    assert math.hypot(found.x - pose[0], found.y - pose[1]) < 0.06
    assert abs(math.remainder(found.yaw - pose[2], math.tau)) < math.radians(1.5)
    sigmas = np.sqrt(np.diag(found.covariance))
    assert (sigmas[:2] < 0.15).all() and sigmas[2] < math.radians(5)


def test_half_of_the_beams_may_be_nonsense(localiser):
    view = view_at(ASKED_FROM[0])
    rng = np.random.default_rng(3)
    ranges = view.scan.ranges_m.copy()
    wrong = rng.random(len(ranges)) < 0.5
    ranges[wrong] = rng.uniform(0.3, 5.0, wrong.sum())
    scan = replace(view.scan, ranges_m=ranges)
    found = localiser.locate([readings_of(replace(view, scan=scan), np.eye(4))])
    assert math.hypot(found.x - ASKED_FROM[0][0], found.y - ASKED_FROM[0][1]) < 0.15


def test_where_nothing_is_near_the_robot_is_lost(localiser):
    near = view_at(ASKED_FROM[0], range_max=0.3)
    found = localiser.locate([readings_of(near, np.eye(4))])
    assert found.lost and found.probability == 0.0


def test_a_place_that_is_not_in_the_map_is_no_place(localiser):
    view = view_at(ASKED_FROM[0])
    ranges = np.random.default_rng(1).uniform(0.5, 3.0, view.scan.ranges_m.size)
    scan = replace(view.scan, ranges_m=ranges.astype(np.float32))
    assert localiser.locate([readings_of(replace(view, scan=scan), np.eye(4))]).lost


def test_alike_rooms_leave_it_lost():
    """Two closed rooms of one size and shape, of a bare square each: eight poses fit."""
    scan = np.full((100, 180), UNKNOWN, np.int8)
    for left in (10, 100):
        scan[10:80, left : left + 70] = STANDS
        scan[12:78, left + 2 : left + 68] = FREE
    unseen = np.full((*scan.shape, SLABS), UNKNOWN, np.int8)
    there = Localiser(HeightBands(scan, unseen, np.zeros(2)))
    angles = np.linspace(0, math.tau, 360, endpoint=False)
    ranges = 1.65 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    view = view_at(ASKED_FROM[0])
    scan = replace(
        view.scan, ranges_m=ranges.astype(np.float32), angle_min=0.0, angle_increment=math.tau / 360
    )
    found = there.locate([readings_of(replace(view, scan=scan), np.eye(4))])
    assert found.lost and found.probability < 0.3


def test_several_views_are_asked_as_one(localiser):
    first, last = (2.3, 1.7, 0.7), (2.6, 1.9, 1.2)
    T_last = T_from_xy_yaw(*last)
    odometry = T_from_xy_yaw(first[0] + 0.05, first[1], first[2] + 0.03)
    views = [
        readings_of(view_at(pose), T).seen_from(np.linalg.inv(T_last) @ T)
        for pose, T in ((first, odometry), (last, T_last))
    ]
    both = joined(views)
    assert len(both) == sum(len(v) for v in views) and len(both.origins_xyz) == 2
    found = localiser.locate(views)
    assert not found.lost
    assert math.hypot(found.x - last[0], found.y - last[1]) < 0.06


def test_odometry_may_err_the_more_the_farther_the_robot_went(localiser):
    here = readings_of(view_at(ASKED_FROM[0]), np.eye(4))
    near, far = (here.seen_from(T_from_xy_yaw(m, 0, m)).sigmas for m in (0.1, 2.0))
    assert (here.sigmas < near).all() and (near < far).all()


@pytest.mark.parametrize("odds", [DEPTH, LASER])
def test_odds_rise_with_the_lead_over_other_poses_and_with_the_fit(odds):
    assert odds.probability(9.0, -0.2, 0.6) > odds.probability(1.0, -0.2, 0.6)
    assert odds.probability(4.0, -0.1, 0.6) > odds.probability(4.0, -0.9, 0.6)
    assert odds.probability(0.0, -1.0, 0.6) < 0.01


def test_what_ends_where_nothing_is_known_may_well_be_there():
    scan = np.full((80, 80), FREE, np.int8)
    slabs = np.full((80, 80, SLABS), FREE, np.int8)
    slabs[0, 0, 20] = STANDS
    unseen = slabs.copy()
    unseen[:, 50:] = UNKNOWN
    ahead = readings_of(seen_at(0, 0, 0, [Box((1.5, -9, 0), (1.6, 9, 2.5))]), np.eye(4))
    middle = np.abs(np.sin(ahead.bearing)) < 0.02
    some = replace(ahead, **{k: getattr(ahead, k)[middle] for k in PER_READING})
    pose = np.array([[2.0, 2.0, 0.0]])
    known, unknown = (
        Localiser(HeightBands(scan, s, np.zeros(2)))._search.log_likelihood_at(pose, some)[0]
        for s in (slabs, unseen)
    )
    met = int((some.kind == HIT).sum())
    assert met and known < unknown == pytest.approx(met * INDEPENDENT_DEPTH * math.log(UNSEEN))


def test_bands_are_stored_and_read_back(bands):
    content = bands.to_bytes()
    assert content == bands.to_bytes()
    again = HeightBands.from_bytes(content)
    assert (again.scan == bands.scan).all() and (again.slabs == bands.slabs).all()
    assert (again.origin_xy == bands.origin_xy).all()
    assert (bands.scan == STANDS).any() and (bands.slabs == UNKNOWN).all()


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 torn"])
def test_a_damaged_state_is_named(content):
    with pytest.raises(MapError, match=r"bands\.npz"):
        HeightBands.from_bytes(content)


# Walls of a 5 m by 4 m room, a wardrobe, a cupboard, a table and a bed.
ROOM = [
    Box((-0.1, 0, 0), (0, 4, 2.5)),
    Box((5, 0, 0), (5.1, 4, 2.5)),
    Box((0, -0.1, 0), (5, 0, 2.5)),
    Box((0, 4, 0), (5, 4.1, 2.5)),
    Box((0, 3.2, 0), (1.4, 4, 1.9)),
    Box((4.5, 1.0, 0), (5, 1.8, 0.9)),
    Box((2.2, 0.0, 0.70), (3.6, 0.7, 0.73)),
    Box((3.2, 2.6, 0.0), (5, 4, 0.5)),
]
CHAIR = Box((1.4, 1.8, 0.0), (1.9, 2.3, 0.9))
SMALL = PinholeCamera(160, 120, 131.0, 131.0, 79.5, 59.5)


def seen_at(x, y, quarter_turns, things):
    """What a camera sees at (x, y) of the room, turned by right angles."""
    turn = np.linalg.matrix_power(np.array([[0, 1], [-1, 0]]), quarter_turns)

    def around(thing):
        corners = (np.array([thing.low[:2], thing.high[:2]]) - [x, y]) @ turn.T
        low, high = corners.min(axis=0), corners.max(axis=0)
        return Box((*low, thing.low[2]), (*high, thing.high[2]))

    view = view_of([FLOOR, *map(around, things)], 1.15, 20.0, camera=SMALL)
    return replace(view, T_map_base=T_from_xy_yaw(x, y, quarter_turns * math.pi / 2))


@pytest.fixture(scope="module")
def furnished() -> Localiser:
    builder = BandBuilder()
    for x, y in ((1.0, 1.0), (2.0, 2.6), (3.0, 1.6), (3.9, 2.1)):
        for quarter_turns in range(4):
            builder.add(seen_at(x, y, quarter_turns, [*ROOM, CHAIR]))
    return Localiser(builder.bands())


@pytest.mark.parametrize("pose", [(1.4, 1.2, 0), (2.7, 1.9, 3), (0.9, 1.4, 1)])
def test_depth_alone_places_a_view_though_a_chair_has_gone(furnished, pose):
    found = furnished.locate([readings_of(seen_at(*pose, ROOM), np.eye(4))])
    assert math.hypot(found.x - pose[0], found.y - pose[1]) < 0.15
    assert abs(math.remainder(found.yaw - pose[2] * math.pi / 2, math.tau)) < math.radians(3)


def test_a_bare_wall_leaves_a_camera_lost(furnished):
    wall = [Box((0.8, -9, 0), (0.9, 9, 2.5))]
    assert furnished.locate([readings_of(seen_at(0, 0, 0, wall), np.eye(4))]).lost


def test_floor_and_what_is_far_say_that_the_way_is_clear():
    readings = readings_of(seen_at(0, 0, 0, [Box((6, -9, 0), (6.1, 9, 2.5))]), np.eye(4))
    assert (readings.kind == CLEAR).all() and not (readings.row == LASER_ROW).any()
    near = readings_of(seen_at(0, 0, 0, [Box((2, -9, 0), (2.1, 9, 2.5))]), np.eye(4))
    met = near.rays()[near.kind == HIT] * near.range_m[near.kind == HIT, None]
    np.testing.assert_allclose(met[:, 0], 2.0, atol=0.06)


def test_slabs_tell_a_table_top_from_what_is_under_and_over_it(furnished):
    builder = BandBuilder()
    for x in (1.0, 2.0, 3.0):
        builder.add(seen_at(x, 2.5, 3, ROOM))
    bands = builder.bands()
    col, row = np.floor((np.array([2.9, 0.4]) - bands.origin_xy) / 0.05).astype(int)
    column = bands.slabs[row, col]
    assert column[round(0.70 / SLAB_M)] == STANDS
    assert (column[round(0.80 / SLAB_M) : round(1.0 / SLAB_M)] == FREE).all()
    assert not (column[round(0.15 / SLAB_M) : round(0.65 / SLAB_M)] == STANDS).any()
