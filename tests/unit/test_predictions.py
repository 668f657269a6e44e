"""The life of predictions: where they may be, what speaks for and against them, how they end."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.flow import ChangeKind, NodeKind, PredictionState, Relation
from afkb.inference import network_of
from afkb.inference.existence import folded
from afkb.inference.update_rules import RULES, in_part
from afkb.knowledge import AfNet
from afkb_mapping.mapper import AffordanceMapper
from afkb_mapping.predictions.whereabouts import Whereabouts
from afkb_mapping.things.visibility import Sight
from mapping_samples import container, support, support_below, support_near, view


@pytest.fixture(scope="module")
def network():
    return network_of(AfNet())


@pytest.fixture
def mapper(network):
    return AffordanceMapper(network, "log-odds")


def expected(mapper, kind=NodeKind.DUAL):
    return [e for e in mapper.finish(np.eye(4)).entities if e.kind is kind]


def hidden_cup(x=2.0, y=0.0, **changes):
    return container(x, y, on_support=False, **changes)


def hides_all(index=0, x=0.0, y=0.0):
    """A view that something before it fills: nothing can be seen to be empty."""
    return view(index, x=x, y=y, depth_m=1.0)


def test_what_is_below_things_lies_under_them(mapper):
    mapper.add(hides_all(), [hidden_cup(), hidden_cup(2.3)], [support_below(0, 1)])
    (found,) = expected(mapper)
    assert found.region.relation is Relation.BELOW
    assert found.region.parts[:, 2].sum() == pytest.approx(1)
    assert found.region.parts[:, 0].min() > 1.7 and found.region.parts[:, 0].max() < 2.6
    assert found.region.tops_m[1] == pytest.approx(0.81)
    assert max(found.category_belief, key=found.category_belief.get) in {
        "Table",
        "KitchenTable",
        "Desk",
    }


def test_what_is_near_a_thing_lies_in_a_ring_about_it(mapper):
    chair = support(2.8, 0.0, z=0.45, width=0.4, depth=0.4)
    mapper.add(view(depth_m=1.0, open_ahead=True), [chair], [support_near(0)])
    (found,) = expected(mapper, NodeKind.CO_OCCURRENCE)
    apart = np.hypot(*(found.region.parts[:, :2] - (2.8, 0.0)).T)
    assert apart.min() > 0.4 and apart.max() < 1.0
    assert found.region.parts[0, 2] == found.region.parts[:, 2].max()


def test_every_step_is_told_and_leads_to_its_probability(mapper):
    for i in range(3):
        mapper.add(hides_all(i, y=0.8 * i), [hidden_cup()], [support_below(0)])
    (found,) = expected(mapper)
    kinds = [change.kind for change in found.history]
    assert kinds[0] is ChangeKind.PREDICTED and ChangeKind.PREDICTED_AGAIN in kinds
    assert folded(found.history) == pytest.approx(found.existence, abs=1e-12)


def test_the_same_thing_from_everywhere_says_little_more_than_once(mapper):
    for i in range(12):
        mapper.add(hides_all(i, x=0.1 * i, y=0.4 * i), [hidden_cup()], [support_below(0)])
    (found,) = expected(mapper)
    assert 0.7 < found.existence < 0.75


def test_another_thing_is_another_piece_of_evidence(mapper):
    mapper.add(hides_all(0), [hidden_cup()], [support_below(0)])
    mapper.add(hides_all(1, y=0.8), [hidden_cup(2.3)], [support_below(0)])
    (found,) = expected(mapper)
    assert found.existence == pytest.approx(RULES["log-odds"](0.7, 0.7), abs=0.01)


def test_what_is_seen_to_be_empty_is_refuted_and_does_not_begin_anew(mapper):
    cup = hidden_cup(bottom=1.0)
    mapper.add(hides_all(0), [cup], [support_below(0)])
    for i in range(1, 4):
        mapper.add(view(i, y=0.4 * (i - 2), depth_m=4.0), [cup], [support_below(0)])
    found = mapper.finish(np.eye(4))
    assert not [e for e in found.entities if e.kind is NodeKind.DUAL]
    (past,) = found.past_predictions
    assert past.state is PredictionState.REFUTED
    assert past.probability > 0.2 and past.history[-1].after < 0.2
    assert found.counts["refuted"] == 1


def test_what_is_hidden_is_not_seen_to_be_empty(mapper):
    for i in range(4):
        mapper.add(hides_all(i, y=0.1 * i), [hidden_cup()], [support_below(0)])
    (found,) = expected(mapper)
    assert found.state is PredictionState.PREDICTED


def test_a_sight_confirms_and_the_map_tells_of_it(mapper):
    mapper.add(hides_all(0), [hidden_cup()], [support_below(0)])
    mapper.add(view(1, x=3.5, yaw=np.pi), [support(2.1, 0.0)], [])
    found = mapper.finish(np.eye(4))
    (past,) = found.past_predictions
    assert (past.state, past.probability) == (PredictionState.CONFIRMED, pytest.approx(0.7))
    assert past.history[-1].kind is ChangeKind.CONFIRMED
    assert past.seen_as in {e.id for e in found.entities}
    assert found.counts["confirmed"] == len(found.closures) == 1


def test_days_later_what_nobody_saw_has_expired(mapper):
    mapper.add(hides_all(0), [hidden_cup()], [support_below(0)])
    mapper.add(replace(view(1, x=-3.0, yaw=np.pi), stamp=3600.0), [], [])
    (found,) = expected(mapper)
    assert found.state is PredictionState.DECAYED and found.existence < 0.7
    mapper.add(replace(view(2, x=-3.0, yaw=np.pi), stamp=3e8), [], [])
    assert not expected(mapper)
    assert mapper.finish(np.eye(4)).counts["expired"] == 1


def test_of_two_orders_the_lower_one_says_where(mapper):
    chair = support(2.8, 0.0, z=0.45, width=0.4, depth=0.4)
    seen = [chair, hidden_cup(2.2)]
    mapper.add(view(depth_m=1.0, open_ahead=True), seen, [support_near(0), support_below(1)])
    found = mapper.finish(np.eye(4))
    (dual,) = [e for e in found.entities if e.kind is NodeKind.DUAL]
    assert not [e for e in found.entities if e.kind is NodeKind.CO_OCCURRENCE]
    assert dual.existence == 0.7
    assert len(dual.axioms) == 2 and len(dual.predicted_from) == 2


points = st.floats(-3, 3)


@given(points, points, st.floats(0.1, 2), st.floats(0.05, 0.5), st.integers(0, 2**32 - 1))
def test_looks_and_walls_keep_a_distribution(x, y, mean, sd, seed):
    rng = np.random.default_rng(seed)
    where = Whereabouts.around(np.array([x, y]), (mean, sd))
    where.unseen = rng.uniform(0, 1, len(where.unseen))
    before = where.open_share
    ratio = where.look(Sight(view(depth_m=float(rng.uniform(0.5, 4)))), (0.6, 0.8))
    assert 0 <= where.open_share <= before <= 1
    assert ratio == pytest.approx(where.open_share / before)
    where.rule_out(rng.random(len(where.unseen)) < 0.5)
    assert where.shares.sum() == pytest.approx(1)


def test_a_look_counts_once():
    where = Whereabouts.even(np.array([1.8, -0.1]), np.array([2.2, 0.1]))
    assert where.look(Sight(view(depth_m=4.0)), (0.9, 1.0)) < 0.1
    assert where.look(Sight(view(depth_m=4.0)), (0.9, 1.0)) == 1.0


@given(st.floats(0.5, 0.95), st.floats(0.05, 0.95), st.sampled_from(["log-odds", "noisy-or"]))
def test_parts_of_a_piece_of_evidence_add_up_to_it(strength, share, rule):
    first, second = (in_part(rule, strength, s) for s in (share, 1 - share))
    assert RULES[rule](first, second) == pytest.approx(strength, abs=1e-9)


def pen_near(anchor):
    """What engraves near a display: too small to be seen through."""
    pen = replace(support_near(anchor, 0.3), size_xy_m=(0.15, 0.02), top_height_m=None)
    return replace(pen, affordances={"EngraveAbility": 1.0}, scale="Small", probability=0.7)


def test_what_is_small_and_missing_in_clear_view_is_less_probable_from_each_viewpoint(mapper):
    seen = [support(2.0, 0.0, z=1.1, width=0.2, depth=0.2)]
    probabilities = []
    for i in range(3):
        mapper.add(view(i, y=0.4 * i, depth_m=2.0), seen, [pen_near(0)])
        mapper.add(view(i, y=0.4 * i, depth_m=2.0), seen, [])
        (pen,) = expected(mapper, NodeKind.CO_OCCURRENCE)
        probabilities.append(pen.existence)
    assert 0.7 > probabilities[0] > probabilities[1] > probabilities[2] > 0.2
    assert ChangeKind.OVERLOOKED in {change.kind for change in pen.history}


def test_what_is_far_off_is_not_looked_for():
    where = Whereabouts.even(np.array([1.7, -0.1]), np.array([1.9, 0.1]))
    clear = where.in_clear_view(Sight(view(depth_m=1.8)), (1.2, 1.2))
    assert clear.all()
    assert where.overlook(clear) == pytest.approx(0.55)
    far = where.in_clear_view(Sight(view(x=-1.7, depth_m=3.5)), (1.2, 1.2))
    assert not far.any()
