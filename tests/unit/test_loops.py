"""Closing loops in small worlds of which the truth is known."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from afkb.flow import Closure, LoopKind, NodeKind
from afkb_mapping.geometry import T_from_xy_yaw, inverse
from afkb_mapping.loops.closing import closed
from afkb_mapping.loops.constellation import recognised
from afkb_mapping.loops.judging import contradicting, ruled_out, unwitnessed
from afkb_mapping.loops.naming import with_loops
from afkb_mapping.loops.pose_graph import Loop, optimised
from afkb_mapping.loops.proposals import Proposal
from afkb_mapping.loops.shared_space import shared_spaces
from afkb_mapping.loops.steps import Constraint, step_between
from afkb_mapping.loops.survey import Survey, apart
from afkb_mapping.loops.verification import verified
from afkb_mapping.loops.way import Way
from loop_samples import errors, landmarks, room, station, tour
from store_samples import sample_map

ROOM_A = [(1, 1, 0.75, 0), (3.2, 1.2, 0.45, 1), (1.5, 3, 0.9, 2), (3, 3.3, 0.6, 3)]
WALLS_A = room(0, 0, 4, 4, "right")
CORRIDOR = [(4, 1.3, 16, 1.3), (4, 2.7, 16, 2.7)]
ALL_ROUND = [(2, 2), (3, 2.5), (2, 3), (1.2, 2), (2, 1.4), (3, 2)]
THERE_AND_BACK = [*ALL_ROUND, (9, 2), (3, 2), *ALL_ROUND[1:], (2.2, 2.2)]
SURE = (0.2, 0.2, 0.1)


def accepted(found):
    return [p for p in found.proposals if p.accepted]


@pytest.mark.parametrize("has_laser", [False, True])
def test_a_robot_that_comes_back_finds_where_it_is(has_laser):
    walls = [*WALLS_A, *CORRIDOR]
    stations, true = tour(THERE_AND_BACK, walls, landmarks(ROOM_A), (0.01, 0.006), has_laser)
    before = errors([s.T_map_base for s in stations], true)
    found = closed(stations)
    after = errors(found.poses, true)
    assert before[-1] > 0.2 and after[-1] < 0.05 and after.mean() < before.mean() / 2
    kind = LoopKind.SCAN if has_laser else LoopKind.CONSTELLATION
    assert found.moved and any(p.kind is kind for p in accepted(found))
    for p in accepted(found):
        drifted = inverse(stations[p.earlier_view].T_map_base) @ stations[p.view].T_map_base
        right = inverse(true[p.earlier_view]) @ true[p.view]
        assert p.corrected_m == pytest.approx(apart(right, drifted)[0], abs=0.08)
    assert np.array_equal(found.poses[0], stations[0].T_placed)


def test_a_way_that_is_right_is_left_alone():
    stations, _ = tour(THERE_AND_BACK, [*WALLS_A, *CORRIDOR], landmarks(ROOM_A))
    found = closed(stations)
    assert not found.moved and not accepted(found) and found.confirmed > 0
    assert np.allclose(found.poses, [s.T_placed for s in stations], atol=1e-12)


def test_rooms_that_look_alike_are_not_merged():
    twin = [(x + 16, *rest) for x, *rest in ROOM_A]
    walls = [*WALLS_A, *CORRIDOR, *room(16, 0, 4, 4, "left")]
    way = [*ALL_ROUND, (17, 2), *[(x + 16, y) for x, y in ALL_ROUND], (18.2, 2.2)]
    stations, true = tour(way, walls, landmarks(ROOM_A + twin), (0.01, 0.003))
    found = closed(stations)
    for p in accepted(found):
        assert np.hypot(*(true[p.view][:2, 3] - true[p.earlier_view][:2, 3])) < 8
    assert errors(found.poses, true).max() < 1.0


def test_two_places_that_explain_a_view_alike_are_ambiguous():
    square = [(1, 1, 0.7, 0), (-1, 1, 0.7, 0), (-1, -1, 0.7, 0), (1, -1, 0.7, 0)]
    lost = np.array([0.5, 0.5, 2.0])
    found = recognised(landmarks(square), landmarks(square), np.eye(4), lost)
    assert found is not None and found.is_ambiguous
    told = [*square[:3], (1, -1, 0.4, 2)]
    found = recognised(landmarks(told), landmarks(told), np.eye(4), lost)
    assert found is not None and np.allclose(found.T_known_view, np.eye(4), atol=1e-6)


def test_movable_things_count_as_little_as_they_move():
    moved = T_from_xy_yaw(0.3, -0.2, 0.1)
    things = landmarks(ROOM_A)
    found = recognised(things, things.seen_from(moved), np.eye(4), np.array(SURE))
    assert found is not None and found.weight == pytest.approx(4)
    assert np.allclose(found.T_known_view, moved, atol=1e-6)
    chairs = replace(things, weight=np.full(4, 0.3))
    assert recognised(chairs, chairs.seen_from(moved), np.eye(4), np.array(SURE)) is None


def test_free_space_where_a_wall_stood_speaks_against():
    here = station(0, np.eye(4), np.eye(4), room(-2, -2, 4, 4, "none"), landmarks([]))
    large = station(1, np.eye(4), np.eye(4), room(-2, -2, 7, 7, "none"), landmarks([]))
    assert verified(here.surface, here, here.surface, np.eye(4), True).constraint is not None
    verdict = verified(here.surface, large, here.surface, np.eye(4), True)
    assert verdict.constraint is None and "seen through" in verdict.reason


def line(n=30):
    poses = [T_from_xy_yaw(0.5 * k, 0, 0) for k in range(n)]
    step = Constraint(T_from_xy_yaw(0.5, 0, 0), np.diag([0.02, 0.02, 0.01]) ** 2)
    return poses, [step] * (n - 1)


def proposal(earlier, later, x):
    tight = np.diag([0.02, 0.02, 0.01]) ** 2
    constraint = Constraint(T_from_xy_yaw(x, 0, 0), tight)
    return Proposal(LoopKind.CONSTELLATION, earlier, later, 3.0, constraint)


def test_a_loop_that_contradicts_the_others_lets_go():
    poses, steps = line()
    right = [proposal(a, a + 20, 10.2) for a in (0, 2, 4, 6)]
    wrong = proposal(3, 23, 9.0)
    found = optimised(poses, steps, [p.loop for p in (*right, wrong)])
    assert found[20][0, 3] == pytest.approx(10.2, abs=0.05)
    checked = contradicting([*right, wrong], found)
    assert [p.constraint is None for p in checked] == [False] * 4 + [True]
    assert "contradict" in checked[-1].reason


def test_the_graph_is_the_same_each_time():
    poses, steps = line()
    loops = [Loop(0, 25, proposal(0, 25, 12.1).constraint)]
    first, second = (optimised(poses, steps, loops) for _ in range(2))
    assert np.array_equal(np.array(first), np.array(second))


def test_odometry_rules_out_what_it_cannot_have_erred():
    stations, _ = tour([(0, 0), (10, 0)], WALLS_A, landmarks([]))
    steps = [step_between(a, b) for a, b in pairwise(stations)]
    survey = Survey(stations, Way(np.eye(4), steps), [s.T_map_base for s in stations])
    assert ruled_out(proposal(0, 15, 7.3), survey).constraint is not None
    rejected = ruled_out(proposal(0, 15, 2.0), survey)
    assert rejected.constraint is None and "odometry" in rejected.reason


def test_a_large_correction_needs_a_second_view():
    stations, _ = tour([(0, 0), (10, 0)], WALLS_A, landmarks([]))
    steps = [step_between(a, b) for a, b in pairwise(stations)]
    survey = Survey(stations, Way(np.eye(4), steps), [s.T_map_base for s in stations])
    large = proposal(0, 15, 8.2)
    (alone,) = unwitnessed([large], survey)
    assert alone.constraint is None and "second view" in alone.reason
    assert all(p.constraint for p in unwitnessed([large, proposal(1, 16, 8.25)], survey))
    assert unwitnessed([large, proposal(1, 16, 6.8)], survey)[0].constraint is None


def test_views_of_one_space_from_two_sides_are_proposed_and_correct_nothing():
    chairs = [(2, 1.4, 0.45, 1), (2.4, 1.4, 0.45, 1), (2, 2.6, 0.45, 1), (2.4, 2.6, 0.45, 1)]
    stations, _ = tour([(0, 0), (5, 0), (5, 4), (0, 4)], WALLS_A, landmarks(chairs))
    sides = [
        replace(s, landmarks=landmarks(chairs[:2] if s.T_map_base[1, 3] < 2 else chairs[2:]))
        for s in stations
    ]
    sides = [
        replace(s, landmarks=s.landmarks.seen_from(np.linalg.inv(s.T_map_base))) for s in sides
    ]
    steps = [step_between(a, b) for a, b in pairwise(sides)]
    survey = Survey(sides, Way(np.eye(4), steps), [s.T_map_base for s in sides])
    found = list(shared_spaces(survey))
    assert found and all(p.constraint is None and p.weight <= 0.65 for p in found)


def test_a_prediction_that_came_true_after_a_way_round_is_a_loop():
    walls = [*WALLS_A, *CORRIDOR]
    stations, _ = tour(THERE_AND_BACK, walls, landmarks([]), (0.01, 0.006))
    last = stations[-1].stamp
    closure = Closure("n1", NodeKind.DUAL, 0.7, 0.1, "p2", last, predicted_stamp=1.0)
    (seen,) = closed(stations, [closure]).proposals
    assert seen.kind is LoopKind.PREDICTION and seen.earlier_view == 1
    soon = replace(closure, stamp=3.0)
    assert not closed(stations, [soon]).proposals


def test_the_map_tells_what_was_closed_and_from_where():
    stations, _ = tour(THERE_AND_BACK, [*WALLS_A, *CORRIDOR], landmarks(ROOM_A), (0.01, 0.006))
    found = closed(stations)
    told = with_loops(sample_map(), found)
    assert told.counts["loops_closed"] == len(accepted(found)) > 0
    assert {p.place for p in told.loops} <= {"p1", "p2"}
