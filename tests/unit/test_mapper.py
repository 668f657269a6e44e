"""Algorithm 1, line by line, on hand-made views."""

from dataclasses import replace

import numpy as np
import pytest

from afkb.flow import EdgeKind, NodeKind
from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb_mapping.mapper import AffordanceMapper
from mapping_samples import DUAL, container, support, support_below, support_near, view


@pytest.fixture(scope="module")
def knowledge_base():
    return AfNet()


@pytest.fixture
def mapper(knowledge_base):
    return AffordanceMapper(network_of(knowledge_base), "log-odds")


def of_kind(found, kind):
    return [e for e in found.entities if e.kind is kind]


def test_cups_over_a_hidden_top_predict_the_support_below_them(mapper):
    cups = [container(2.0, 0.0, on_support=False), container(2.3, 0.2, on_support=False)]
    mapper.add(view(), cups, [support_below(0, 1)])
    found = mapper.finish(np.eye(4))
    (prediction,) = of_kind(found, NodeKind.DUAL)
    assert prediction.existence == 0.7
    assert prediction.axioms == (DUAL,)
    cups_seen = of_kind(found, NodeKind.OBSERVED)
    assert {c.id for c in cups_seen} == set(prediction.predicted_from)
    assert {c.supported_by for c in cups_seen} == {prediction.id}
    column, row = ((np.array([2.15, 0.1]) - found.grid.origin_xy) / 0.05).astype(int)
    assert found.grid.probability[row, column] == pytest.approx(0.7, abs=0.03)


def test_the_predicted_support_once_seen_closes_the_loop(mapper):
    mapper.add(view(0), [container(2.0, 0.0, on_support=False)], [support_below(0)])
    mapper.add(view(1, x=3.5, yaw=np.pi), [support(2.1, 0.0)], [])
    found = mapper.finish(np.eye(4))
    assert not of_kind(found, NodeKind.DUAL)
    (closure,) = found.closures
    assert closure.predicted_as is NodeKind.DUAL
    assert closure.displacement_m == pytest.approx(0.1, abs=0.05)
    (table,) = [e for e in found.entities if "SupportAbility" in e.affordances]
    assert table.predicted_first is NodeKind.DUAL
    assert table.existence > 0.9
    assert table.position_xyz == pytest.approx((2.1, 0.0, 0.75), abs=0.03)


def test_a_doubtful_support_confirms_nothing(mapper):
    mapper.add(view(0), [container(2.0, 0.0, on_support=False)], [support_below(0)])
    doubtful = replace(support(2.1, 0.0), measures={"score": 0.3})
    mapper.add(view(1, x=3.5, yaw=np.pi, depth_m=0.9), [doubtful], [])
    found = mapper.finish(np.eye(4))
    assert not found.closures and of_kind(found, NodeKind.DUAL)
    mapper.add(view(2, x=3.5, y=1.0, yaw=np.pi), [support(2.1, 0.0)], [])
    found = mapper.finish(np.eye(4))
    assert len(found.closures) == 1 and not of_kind(found, NodeKind.DUAL)


def test_a_closure_tells_of_the_whole_that_its_part_became(mapper):
    cup = container(2.0, 0.0, on_support=False)
    mapper.add(view(0), [cup, support(2.9, 0.0, width=0.4, cut=True)], [support_below(0)])
    mapper.add(view(1, x=3.5, yaw=np.pi), [support(1.9, 0.0, width=0.4, cut=True)], [])
    for i in range(2, 5):
        mapper.add(view(i, x=3.5, y=0.3 * i, yaw=np.pi), [support(2.4, 0.0, width=1.4)], [])
    found = mapper.finish(np.eye(4))
    (table,) = [e for e in found.entities if "SupportAbility" in e.affordances]
    (closure,) = found.closures
    assert closure.entity == table.id
    assert closure.displacement_m == pytest.approx(0.4, abs=0.05)


def test_a_support_that_is_in_the_map_already_is_not_predicted(mapper):
    mapper.add(view(0), [support(2.0, 0.0)], [])
    mapper.add(view(1, x=0.6, depth_m=1.0), [container(2.0, 0.0)], [support_below(0)])
    found = mapper.finish(np.eye(4))
    assert not of_kind(found, NodeKind.DUAL)
    (cup,) = [e for e in found.entities if "ContainAbility" in e.affordances]
    (table,) = [e for e in found.entities if "SupportAbility" in e.affordances]
    assert cup.supported_by == table.id


@pytest.mark.parametrize(("step", "grows"), [(0.0, False), (0.8, True)])
def test_repeated_prediction_counts_once_per_distinct_viewpoint(mapper, step, grows):
    for i in range(3):
        cup = container(2.0, 0.0, on_support=False)
        mapper.add(view(i, y=step * i, depth_m=1.0), [cup], [support_below(0)])
    (prediction,) = of_kind(mapper.finish(np.eye(4)), NodeKind.DUAL)
    assert (prediction.existence > 0.7) is grows


def test_what_is_seen_through_fades(mapper):
    mapper.add(view(0, depth_m=2.0), [container(2.0, 0.0, bottom=1.1)], [])
    before = of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)[0].existence
    for i in range(1, 4):
        mapper.add(view(i, y=0.2 * (-1) ** i * i, depth_m=4.0), [], [])
    after = of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)
    assert not after or after[0].existence < before


def test_what_is_hidden_does_not_fade(mapper):
    mapper.add(view(0, depth_m=2.0), [container(2.0, 0.0, bottom=1.1)], [])
    before = of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)[0].existence
    for i in range(1, 4):
        mapper.add(view(i, y=0.2 * (-1) ** i * i, depth_m=1.0), [], [])
    assert of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)[0].existence == before


def test_what_co_occurs_is_expected_where_nothing_has_been_seen(mapper):
    chair = support(2.8, 0.0, z=0.45, width=0.4, depth=0.4)
    mapper.add(view(open_ahead=True), [chair], [support_near(0)])
    found = mapper.finish(np.eye(4))
    (prediction,) = of_kind(found, NodeKind.CO_OCCURRENCE)
    assert prediction.existence == 0.65
    assert np.hypot(prediction.position_xyz[0] - 2.8, prediction.position_xyz[1]) == pytest.approx(
        0.7, abs=0.05
    )


def test_nothing_is_expected_behind_a_wall(mapper):
    chair = support(2.7, 0.0, z=0.45, width=0.4, depth=0.4)
    mapper.add(view(), [chair], [support_near(0)])
    assert not of_kind(mapper.finish(np.eye(4)), NodeKind.CO_OCCURRENCE)


def test_one_cup_seen_thirty_times_is_one_node(mapper):
    rng = np.random.default_rng(0)
    for i in range(30):
        x, y = rng.normal((2.0, 0.0), 0.01)
        mapper.add(view(i, x=0.02 * i), [container(x, y)], [])
    (cup,) = of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)
    assert cup.observations == 30
    assert cup.position_xyz[:2] == pytest.approx((2.0, 0.0), abs=0.02)
    assert cup.movability == "Dynamic"
    assert cup.matching_weight == pytest.approx(0.3, abs=0.1)


def test_two_cups_side_by_side_stay_two(mapper):
    for i in range(5):
        mapper.add(view(i, x=0.1 * i), [container(2.0, 0.0), container(2.0, 0.12)], [])
    mapper.add(view(6, x=0.7, depth_m=1.0), [container(2.0, 0.12)], [])
    assert len(of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)) == 2


def test_neighbouring_tables_of_one_height_stay_two_and_halves_become_one(mapper):
    for i in range(2):
        mapper.add(view(i, x=0.1 * i), [support(2.0, 0.0), support(2.0, 0.86)], [])
    assert len(of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)) == 2
    left, right = support(5.0, 0.0, cut=True), support(6.1, 0.0, cut=True)
    for i in range(2, 4):
        mapper.add(view(i, x=2 + 0.1 * i), [left], [])
        mapper.add(view(10 + i, x=2 + 0.1 * i), [right], [])
    tables = of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)
    assert len(tables) == 3
    assert max(t.size_xyz[0] for t in tables) == pytest.approx(2.3, abs=0.1)


def test_edges_carry_distance_bearing_and_linkage_angle(mapper):
    mapper.add(view(0, yaw=0.5), [support(2.0, 2.0)], [])
    found = mapper.finish(np.eye(4))
    (edge,) = [e for e in found.edges if e.kind is EdgeKind.OBSTACLE]
    assert edge.distance == pytest.approx(np.hypot(2, 2), abs=0.05)
    assert edge.bearing == pytest.approx(np.pi / 4, abs=0.02)
    assert edge.linkage_angle == pytest.approx(abs(0.5 - np.pi / 4), abs=0.02)


def test_turning_on_the_spot_is_one_place_and_new_affordances_elsewhere_another(mapper):
    for i in range(6):
        mapper.add(view(i, yaw=i), [support(2.0 * np.cos(i), 2.0 * np.sin(i))], [])
    mapper.add(view(7, x=4.0), [support(6.0, 0.0)], [])
    found = mapper.finish(np.eye(4))
    assert len(found.places) == 2
    (way,) = [e for e in found.edges if e.kind is EdgeKind.PATH]
    assert way.distance == pytest.approx(4.0)


def test_an_affordance_that_the_ontology_lacks_is_kept_in_the_map(mapper):
    lamp = replace(container(2.0, 0.0), affordances={"GlowAbility": 0.9})
    mapper.add(view(), [lamp], [])
    (entity,) = of_kind(mapper.finish(np.eye(4)), NodeKind.OBSERVED)
    assert entity.affordances == {"GlowAbility": pytest.approx(0.9)}
    assert sum(entity.category_belief.values()) == pytest.approx(1.0)


def test_the_same_input_gives_the_same_map(knowledge_base):
    def made():
        mapper = AffordanceMapper(network_of(knowledge_base), "noisy-or")
        for i in range(4):
            cups = [container(2.0, 0.0), container(2.2, 0.3)]
            mapper.add(view(i, y=0.4 * i), [*cups, support(2.1, 0.1)], [support_below(0, 1)])
        return mapper.finish(np.eye(4))

    first, second = made(), made()
    assert [repr(e) for e in first.entities] == [repr(e) for e in second.entities]
    np.testing.assert_array_equal(first.grid.probability, second.grid.probability)
