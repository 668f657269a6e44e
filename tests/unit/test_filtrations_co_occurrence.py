from pathlib import Path

import pytest

from afkb.flow import Detection, Relation
from afkb.knowledge import AfNet
from afkb.plugins.protocols import Predictor
from afkb_filtrations import afkb_predictors
from afkb_filtrations.co_occurrence import CoOccurrencePredictor
from afkb_filtrations.duals import DualPredictor
from afkb_filtrations.localizer import Localizer
from ontology_samples import Copy
from test_filtrations_duals import table, thing


@pytest.fixture(scope="module")
def predictor() -> CoOccurrencePredictor:
    return CoOccurrencePredictor(AfNet())


def chair(x: float, y: float = 0.0) -> Detection:
    return thing("SupportAbility", (x, y, 0.40), (0.44, 0.44, 0.05))


def test_a_chair_predicts_a_larger_support_near_it(predictor: CoOccurrencePredictor) -> None:
    (found,) = predictor.predict([chair(2)])
    assert (found.relation, found.order, found.anchors) == (Relation.NEAR, 2, (0,))
    assert found.affordances == {"SupportAbility": 1.0}
    assert found.scale == "Large"
    assert found.probability == pytest.approx(0.65)
    assert found.axiom == "https://w3id.org/afkb/afnet#LargerSupportNearSeat"
    assert found.top_height_m is not None
    assert found.top_height_m[0] < 0.73 < found.top_height_m[1]
    assert found.distance_m[0] > 0


def test_a_table_that_is_seen_near_is_not_predicted(predictor: CoOccurrencePredictor) -> None:
    assert predictor.predict([chair(2), table(2.9, 0)]) == []
    assert len(predictor.predict([chair(2), table(6, 0)])) == 1


def test_chairs_about_one_table_predict_one(predictor: CoOccurrencePredictor) -> None:
    found = predictor.predict([chair(2), chair(3.2), chair(9)])
    assert [h.anchors for h in found] == [(0, 1), (2,)]


def test_floor_tables_and_beds_predict_no_larger_thing(predictor: CoOccurrencePredictor) -> None:
    floor = thing("SupportAbility", (0, 0, -0.02), (4.0, 3.0, 0.02))
    bed = thing("SupportAbility", (0, 0, 0.3), (2.0, 1.5, 0.2))
    assert predictor.predict([floor, table(1, 1), bed]) == []


def test_halving_the_rule_lowers_the_prediction_and_deleting_it_ends_it(
    tmp_path: Path, predictor: CoOccurrencePredictor
) -> None:
    (before,) = predictor.predict([chair(2)])
    copy = Copy().set("LargerSupportNearSeat", "strength", 0.325)
    for pair in ("ChairSuggestsTable", "ChairSuggestsDesk"):
        copy.set(pair, "strength", 0.325)
    (after,) = CoOccurrencePredictor(copy.load(tmp_path)).predict([chair(2)])
    assert after.probability == pytest.approx(before.probability / 2, abs=0.02)
    gone = copy.delete("LargerSupportNearSeat").load(tmp_path)
    assert CoOccurrencePredictor(gone).predict([chair(2)]) == []


def test_a_listed_pair_sets_the_strength_for_its_category(tmp_path: Path) -> None:
    copy = Copy().set("ChairSuggestsTable", "strength", 0.95)
    (found,) = CoOccurrencePredictor(copy.load(tmp_path)).predict([chair(2)])
    assert found.probability > 0.8


def test_the_hook_brings_both_orders() -> None:
    predictors = list(afkb_predictors(knowledge_base=AfNet()))
    assert [(p.name, p.order) for p in predictors] == [("duals", 1), ("co-occurrence", 2)]
    assert all(isinstance(p, Predictor) for p in predictors)


def test_the_localizer_puts_what_supports_and_contains_first_coarse_before_fine() -> None:
    cup = thing("ContainAbility", (2, 0, 0.73))
    package = thing("IntrinsicContainAbility", (3, 0, 0.73), (0.4, 0.3, 0.3))
    pen = thing("EngraveAbility", (2, 0, 0.73), (0.15, 0.01, 0.01))
    seen = [pen, cup, chair(1), package, table(5, 0)]
    localizer = Localizer(AfNet())
    assert localizer.localized(seen) == [4, 2, 3, 1]
    assert localizer.coarse_first(seen) == [4, 2, 3, 1, 0]


def test_what_is_coarse_is_predicted_before_what_is_fine() -> None:
    book = thing("DisplayAbility", (2, 0, 0.73), (0.25, 0.2, 0.03))
    found = DualPredictor(AfNet()).predict([book, thing("ContainAbility", (4, 0, 0.73))])
    assert [h.scale for h in found] == ["Large", "Small"]
