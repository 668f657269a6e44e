"""Self-localisation with a laser in a drawn flat: found, in doubt, or lost."""

import math
from dataclasses import replace

import numpy as np
import pytest

import laser_samples as samples
from afkb.errors import MapError
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.localisation.bands import ANY, SCAN, BandBuilder, HeightBands
from afkb_mapping.localisation.localiser import Localiser
from afkb_mapping.localisation.readings import joined, readings_of

MAPPED_FROM = [(2, 2, 0), (2.5, 2.5, 1), (5, 2, 0), (7, 2, 2), (7, 4, 0), (3, 3, 2)]
ASKED_FROM = [(2.3, 1.7, 0.7), (6.6, 2.4, -2.0), (7.2, 3.6, 3.0)]


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
    occupancy = np.full((3, 100, 180), -1, np.int8)
    for left in (10, 100):
        occupancy[SCAN, 10:80, left : left + 70] = 95
        occupancy[SCAN, 12:78, left + 2 : left + 68] = 5
    there = Localiser(HeightBands(occupancy, np.zeros(2)))
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
    assert len(both) == sum(len(v) for v in views) and len(both.origins_xy) == 2
    found = localiser.locate(views)
    assert not found.lost
    assert math.hypot(found.x - last[0], found.y - last[1]) < 0.06


def test_bands_are_stored_and_read_back(bands):
    content = bands.to_bytes()
    assert content == bands.to_bytes()
    again = HeightBands.from_bytes(content)
    assert (again.occupancy == bands.occupancy).all()
    assert (again.origin_xy == bands.origin_xy).all()
    assert bands.stands(SCAN).any() and not bands.stands(ANY).any()


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 torn"])
def test_a_damaged_state_is_named(content):
    with pytest.raises(MapError, match=r"bands\.npz"):
        HeightBands.from_bytes(content)
