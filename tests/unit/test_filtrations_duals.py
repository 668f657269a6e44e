from pathlib import Path

import numpy as np
import pytest

from afkb.flow import Detection, OrientedBox, Relation
from afkb.knowledge import AfNet
from afkb_filtrations.duals import DualPredictor
from ontology_samples import Copy, extension


@pytest.fixture(scope="module")
def predictor() -> DualPredictor:
    return DualPredictor(AfNet())


def thing(
    affordances: dict[str, float] | str,
    xyz: tuple[float, float, float],
    size: tuple[float, float, float] = (0.09, 0.08, 0.1),
) -> Detection:
    """A detection whose box stands with its bottom at z; position at its top if it supports."""
    named = {affordances: 0.9} if isinstance(affordances, str) else affordances
    center = (xyz[0], xyz[1], xyz[2] + size[2] / 2)
    z = xyz[2] + size[2] if "SupportAbility" in named else center[2]
    return Detection(
        detector="test",
        affordances=named,
        box=OrientedBox(center, size),
        position_xyz=np.array([xyz[0], xyz[1], z]),
        covariance_xyz=np.eye(3) * 1e-4,
        footprint_xy=np.array([xyz[:2]]),
        n_pixels=500,
        range_m=2.0,
    )


def table(x: float, y: float, top: float = 0.73) -> Detection:
    return thing("SupportAbility", (x, y, top - 0.03), (1.2, 0.8, 0.03))


def test_a_container_predicts_a_support_below_it(predictor: DualPredictor) -> None:
    (found,) = predictor.predict([thing("ContainAbility", (2, 0, 0.73))])
    assert found.relation is Relation.BELOW
    assert found.order == 1
    assert found.anchors == (0,)
    assert found.affordances == {"SupportAbility": 1.0}
    assert found.probability == pytest.approx(0.7)
    assert found.axiom == "https://w3id.org/afkb/afnet#ContainPredictsSupportBelow"
    assert found.categories is None


def test_containers_that_may_share_a_support_predict_one(predictor: DualPredictor) -> None:
    cups = [thing("ContainAbility", (2 + 0.3 * i, 0.1 * i, 0.73)) for i in range(3)]
    (found,) = predictor.predict(cups)
    assert found.anchors == (0, 1, 2)
    assert found.probability == pytest.approx(0.7)


def test_containers_far_apart_or_at_other_heights_do_not_share(predictor: DualPredictor) -> None:
    far = [thing("ContainAbility", (x, 0, 0.73)) for x in (0, 3)]
    assert [h.anchors for h in predictor.predict(far)] == [(0,), (1,)]
    shelf = [thing("ContainAbility", (2, 0, z)) for z in (1.4, 0.73)]
    assert [h.anchors for h in predictor.predict(shelf)] == [(1,), (0,)]


def test_open_and_closed_containers_share_a_support(predictor: DualPredictor) -> None:
    closed = {"ContainAbility": 0.9, "IntrinsicContainAbility": 0.9}
    things = [thing(closed, (2, 0, 0.73)), thing("ContainAbility", (2.3, 0, 0.73))]
    (found,) = predictor.predict(things)
    assert found.anchors == (0, 1)


def test_what_stands_on_the_floor_predicts_nothing(predictor: DualPredictor) -> None:
    assert predictor.predict([thing("ContainAbility", (2, 0, 0.02), (0.4, 0.4, 0.5))]) == []


def test_a_support_that_is_seen_is_not_predicted(predictor: DualPredictor) -> None:
    cup = thing("ContainAbility", (2.5, 0.2, 0.73))
    assert predictor.predict([cup, table(2, 0)]) == []
    assert len(predictor.predict([cup, table(5, 0)])) == 1
    assert len(predictor.predict([cup, table(2, 0, top=0.45)])) == 1


def test_displays_predict_pens_and_pens_hardly_displays(predictor: DualPredictor) -> None:
    book = thing("DisplayAbility", (2, 0, 0.73), (0.25, 0.2, 0.03))
    (found,) = predictor.predict([book])
    assert (found.relation, found.affordances) == (Relation.NEAR, {"EngraveAbility": 1.0})
    assert predictor.predict([thing("EngraveAbility", (2, 0, 0.73), (0.15, 0.01, 0.01))]) == []


def test_a_doubtful_container_predicts_nothing(predictor: DualPredictor) -> None:
    assert predictor.predict([thing({"ContainAbility": 0.3}, (2, 0, 0.73))]) == []


def test_unknown_affordances_of_a_strangers_detector_are_left_alone(
    predictor: DualPredictor,
) -> None:
    assert predictor.predict([thing("HoverAbility", (2, 0, 0.73))]) == []
    assert predictor.predict([]) == []


def test_halving_a_dual_halves_the_prediction(tmp_path: Path) -> None:
    copy = Copy().set("ContainPredictsSupportBelow", "strength", 0.35)
    cup = thing("ContainAbility", (2, 0, 0.73))
    (found,) = DualPredictor(copy.load(tmp_path)).predict([cup])
    assert found.probability == pytest.approx(0.35)


def test_deleting_a_dual_deletes_the_prediction(tmp_path: Path) -> None:
    changed = Copy().delete("ContainPredictsSupportBelow").load(tmp_path)
    cup = thing("ContainAbility", (2, 0, 0.73))
    package = thing("IntrinsicContainAbility", (2, 0, 0.73))
    assert DualPredictor(changed).predict([cup]) == []
    assert len(DualPredictor(changed).predict([package])) == 1


def test_a_dual_of_an_extension_predicts_with_no_change_of_code(tmp_path: Path) -> None:
    body = """
    <afn:Dual rdf:about="https://example.org/home#SupportPredictsDisplayOn">
     <afn:evidence rdf:resource="https://w3id.org/afkb/afnet#SupportAbility"/>
     <afn:predicted rdf:resource="https://w3id.org/afkb/afnet#DisplayAbility"/>
     <afn:relation>on</afn:relation><afn:strength>0.5</afn:strength>
     <afn:evidenceBottomMin>0.4</afn:evidenceBottomMin>
     <afn:predictedScale rdf:resource="https://w3id.org/afkb/afnet#Small"/>
    </afn:Dual>"""
    base = AfNet(extensions=[extension(tmp_path, body)])
    (found,) = DualPredictor(base).predict([table(2, 0)])
    assert found.relation is Relation.ON
    assert found.axiom == "https://example.org/home#SupportPredictsDisplayOn"
    book = thing("DisplayAbility", (2.2, 0.1, 0.73), (0.25, 0.2, 0.03))
    with_book = DualPredictor(base).predict([table(2, 0), book])
    assert [h.relation for h in with_book] == [Relation.NEAR]
