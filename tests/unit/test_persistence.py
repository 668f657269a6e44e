"""Beliefs over time: the persistence filter, and what it makes of things between visits."""

import math
from dataclasses import replace

import numpy as np
import pytest

from afkb.flow import Bound, Doorway, NodeKind, OccupancyGrid
from afkb.inference import network_of
from afkb.inference.update_rules import CERTAIN, against
from afkb.knowledge import AfNet
from afkb_mapping.mapper import AffordanceMapper
from afkb_mapping.visits.bounds_now import bound_now, doorway_now
from afkb_mapping.visits.persistence import WEEK_S, aged, hazard_of
from mapping_samples import container, support, view

DAY_S = 24 * 3600.0


def persistence(looks, now, hazard, missed, false):
    """Rosen, Mason and Leonard 2016, eq. 5 to 12, summed over every time a thing may have gone.

    `looks`: (time, whether it was seen). It was surely there at time 0.
    """
    times = [t for t, _ in looks]
    likelihood = {True: (1 - missed, false), False: (missed, 1 - false)}

    def of_looks(survived):
        return math.prod(likelihood[seen][i >= survived] for i, (_, seen) in enumerate(looks))

    ends = [0.0, *times, now]
    evidence = sum(
        of_looks(n) * (math.exp(-hazard * ends[n]) - math.exp(-hazard * ends[n + 1]))
        for n in range(len(looks) + 1)
    )
    there = of_looks(len(looks)) * math.exp(-hazard * now)
    return there / (evidence + there)


@pytest.mark.parametrize("seen", [(True, True), (False, True), (True, False), (False, False)])
def test_the_recursion_is_the_persistence_filter(seen):
    hazard, missed, false = hazard_of(0.3), 0.2, 0.05
    looks = list(zip((DAY_S, 4 * DAY_S), seen, strict=True))
    p, before = 1.0, 0.0
    for t, is_seen in looks:
        ratio = (1 - missed) / false if is_seen else missed / (1 - false)
        p, before = against(aged(p, t - before, hazard), ratio), t
    p = aged(p, DAY_S, hazard)
    assert p == pytest.approx(persistence(looks, 5 * DAY_S, hazard, missed, false))


def test_the_hazard_is_that_of_the_ontologys_weight():
    assert aged(1.0, WEEK_S, hazard_of(0.3)) == pytest.approx(0.3)
    assert aged(1.0, WEEK_S, hazard_of(1.0)) == pytest.approx(0.99)
    assert aged(0.8, -5.0, hazard_of(0.3)) == 0.8


@pytest.fixture
def mapper():
    return AffordanceMapper(network_of(AfNet()), "log-odds")


def at(index, day, **pose):
    return replace(view(index, **pose), stamp=day * DAY_S + index)


def observed(mapper):
    found = mapper.finish(np.eye(4)).entities
    return {e.affords("SupportAbility"): e for e in found if e.kind is NodeKind.OBSERVED}


def test_what_nobody_looked_at_for_days_fades_by_its_movability(mapper):
    for i in range(3):
        mapper.add(at(i, 0, y=0.4 * i), [container(2.0, 0.0), support(2.0, 1.0)], [])
    before = observed(mapper)
    mapper.add(at(3, 3, x=-50.0, yaw=np.pi), [], [])
    after = observed(mapper)
    lost = {of: before[of].existence - after[of].existence for of in (False, True)}
    assert lost[False] > 0.2 and after[False].existence > 0.5
    assert 0 < lost[True] < 0.02


def test_within_minutes_nothing_fades(mapper):
    for i in range(3):
        mapper.add(view(i, y=0.4 * i), [container(2.0, 0.0)], [])
    before = observed(mapper)[False].existence
    mapper.add(view(100, x=-50.0, yaw=np.pi), [], [])
    assert observed(mapper)[False].existence == before


def test_on_another_day_a_look_from_the_same_place_tells_anew(mapper):
    for i in range(3):
        mapper.add(at(i, 0), [container(2.0, 0.0, bottom=1.1)], [])
    first = observed(mapper)[False].existence
    mapper.add(at(4, 1), [container(2.0, 0.0, bottom=1.1)], [])
    assert observed(mapper)[False].existence > first
    mapper.add(at(5, 2, depth_m=4.0), [], [])
    assert not observed(mapper)


def test_what_is_put_where_something_was_taken_away_is_a_new_thing(mapper):
    mapper.add(at(0, 0), [container(2.0, 0.0, bottom=1.1)], [])
    first = observed(mapper)[False].id
    for i in range(1, 4):
        mapper.add(at(i, 1, depth_m=4.0, y=0.2 * i), [], [])
    for i in range(4, 6):
        mapper.add(at(i, 2), [container(2.0, 0.0, bottom=1.1)], [])
    assert observed(mapper)[False].id != first


def test_a_wall_goes_by_the_beams_that_pass_there_and_a_doorway_by_those_that_end_in_it():
    probability = np.full((20, 40), 0.1, np.float32)
    probability[10, :20] = 0.9
    grid = OccupancyGrid(probability, 0.05, (0.0, 0.0))
    wall = Bound("b", (0.02, 0.52), (0.98, 0.52), 3, (), last_seen=10.0)
    assert bound_now(wall, grid, 10.0).existence == CERTAIN
    assert bound_now(wall, grid, 10.0 + 52 * WEEK_S).existence == pytest.approx(0.99**52, abs=0.01)
    torn_down = replace(wall, start_xy=(1.1, 0.52), end_xy=(1.9, 0.52))
    assert bound_now(torn_down, grid, 10.0).existence == pytest.approx(1 - CERTAIN)
    gap = Doorway("d", 1.5, 0.52, np.pi / 2, 0.9, ())
    assert doorway_now(gap, grid).existence == CERTAIN
    assert doorway_now(replace(gap, x=0.5), grid).existence == pytest.approx(1 - CERTAIN)
