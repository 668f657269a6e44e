"""Scores become probabilities by a counted curve, and the bench's arithmetic of how well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.flow import Detection, OrientedBox, View
from afkb_mapping.calibration import (
    CalibratedDetector,
    Curve,
    calibrated,
    read_curves,
    terms_of,
)
from bench.calibration.fitting import curves_of, fitted
from bench.calibration.held_out import held_out
from bench.calibration.measures import (
    area_under_curve,
    brier_skill,
    expected_calibration_error,
    reliability,
)
from bench.calibration.samples import Sample
from depth_samples import FLOOR, view_of

SUPPORT = Detection(
    detector="told",
    affordances={"SupportAbility": 0.5, "SitAbility": 0.25},
    box=OrientedBox((0.0, 0.0, 0.4), (1.0, 1.0, 0.0)),
    position_xyz=np.zeros(3),
    covariance_xyz=np.eye(3),
    footprint_xy=np.zeros((1, 2)),
    n_pixels=1000,
    range_m=2.0,
)
TABLE = """detector,feature,intercept,slope,log_range,log_pixels,log_size,cut,examples
told,SupportAbility,1.0,2.0,0,0,0,0,40
another,SupportAbility,9,9,9,9,9,9,1
"""


class Told:
    """A detector that always says the same."""

    name = "told"
    affordances = ("SupportAbility", "SitAbility")
    stage = 0

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        return [SUPPORT]


@pytest.fixture
def view() -> View:
    return view_of([FLOOR])


def said(score: float, range_m: float = 2.0, n_pixels: int = 1000) -> Detection:
    affordances = {"SupportAbility": score}
    return replace(SUPPORT, affordances=affordances, range_m=range_m, n_pixels=n_pixels)


def probability(curve: Curve, claim: Detection) -> float:
    return curve.probability(terms_of(claim, "SupportAbility"))


def sample(score: float, right: bool, building: str = "a", range_m: float = 2.0) -> Sample:
    return Sample(
        building=building,
        scene=building,
        thing="x",
        detector="told",
        feature="SupportAbility",
        score=score,
        p=score,
        range_m=range_m,
        terms=terms_of(said(score, range_m), "SupportAbility"),
        right=right,
    )


def drawn(n: int, rng: np.random.Generator) -> list[Sample]:
    """A detector that is right as often as the square of its score."""
    scores = rng.uniform(0.02, 0.98, n)
    right = rng.random(n) < scores**2
    return [
        sample(float(s), bool(r), "ab"[i % 2])
        for i, (s, r) in enumerate(zip(scores, right, strict=True))
    ]


CURVES = [fitted(drawn(30, np.random.default_rng(seed))) for seed in range(5)]


def test_a_table_makes_probabilities_of_scores(tmp_path: Path, view: View) -> None:
    (tmp_path / "calibration.csv").write_text(TABLE)
    detector = calibrated(Told(), tmp_path / "calibration.csv")
    (found,) = detector.detect(view, ())
    assert found.affordances["SupportAbility"] == pytest.approx(1 / (1 + np.exp(-1.0)))
    assert found.affordances["SitAbility"] == SUPPORT.affordances["SitAbility"]
    assert replace(found, affordances=SUPPORT.affordances).box == SUPPORT.box
    assert (detector.name, detector.stage) == ("told", 0)


def test_without_a_table_a_detector_is_left_alone(tmp_path: Path) -> None:
    told = Told()
    assert calibrated(told, tmp_path / "calibration.csv") is told
    assert read_curves(tmp_path / "calibration.csv", "told") == {}


def test_what_is_impossible_stays_so_and_nothing_becomes_certain() -> None:
    detector = CalibratedDetector(Told(), dict.fromkeys(Told.affordances, Curve(intercept=50.0)))
    both = replace(SUPPORT, affordances={"SupportAbility": 0.0, "SitAbility": 1.0})
    found = detector.calibrate(both).affordances
    assert found["SupportAbility"] == 0.0 and 0.99 < found["SitAbility"] < 1.0


@given(
    st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 20.0), st.integers(0, 10**6),
    st.sampled_from(CURVES),
)  # fmt: skip
def test_a_better_score_is_never_less_probable(
    a: float, b: float, range_m: float, pixels: int, curve: Curve
) -> None:
    low, high = (probability(curve, said(s, range_m, pixels)) for s in sorted((a, b)))
    assert 0.0 <= low <= high <= 1.0


def test_a_fitted_curve_states_what_comes_true_elsewhere() -> None:
    samples = drawn(2000, np.random.default_rng(1))
    right = np.array([s.right for s in samples], float)
    assert expected_calibration_error(np.array([s.score for s in samples]), right) > 0.12
    elsewhere = held_out(samples)
    p = np.array([s.p for s in elsewhere])
    right = np.array([s.right for s in elsewhere], float)
    one = np.array(["c"] * len(p))
    assert expected_calibration_error(p, right) < 0.05
    assert brier_skill(p, right, one) > 0.3
    assert area_under_curve(p, right, one) > 0.8


def test_distance_is_counted() -> None:
    rng = np.random.default_rng(2)
    near = [sample(0.7, bool(rng.random() < 0.9), range_m=1.0) for _ in range(300)]
    far = [sample(0.7, bool(rng.random() < 0.3), range_m=4.0) for _ in range(300)]
    curve = fitted(near + far)
    assert probability(curve, said(0.7, 1.0)) == pytest.approx(0.9, abs=0.05)
    assert probability(curve, said(0.7, 4.0)) == pytest.approx(0.3, abs=0.05)


def test_few_examples_change_little() -> None:
    few = [sample(0.7, False), sample(0.7, True)]
    assert probability(fitted(few), said(0.7)) == pytest.approx(0.7, abs=0.15)


def test_a_feature_that_is_never_right_gets_a_curve_of_its_own() -> None:
    often = drawn(200, np.random.default_rng(3))
    never = [replace(s, feature="SitAbility", right=False) for s in often[:40]]
    curves = curves_of(often + never)
    assert set(curves) == {"SitAbility", "SupportAbility"}
    assert probability(curves["SitAbility"], said(0.8)) < 0.15
    assert probability(curves["SupportAbility"], said(0.8)) > 0.5


def test_a_building_is_judged_by_curves_of_the_others() -> None:
    right = [sample(0.6, True, "a") for _ in range(50)]
    wrong = [sample(0.6, False, "b") for _ in range(50)]
    of = {b: [s.p for s in held_out(right + wrong) if s.building == b] for b in "ab"}
    assert max(of["a"]) < 0.2 < 0.8 < min(of["b"])


def test_measures_of_known_cases() -> None:
    right = np.array([1.0, 1.0, 0.0, 0.0])
    one = np.array(["c"] * 4)
    perfect, constant = np.array([0.9, 0.8, 0.2, 0.1]), np.full(4, 0.5)
    assert area_under_curve(perfect, right, one) == 1.0
    assert area_under_curve(constant, right, one) == 0.5
    assert brier_skill(constant, right, one) == 0.0
    assert brier_skill(right, right, one) == 1.0
    assert expected_calibration_error(constant, right) == 0.0
    assert expected_calibration_error(perfect, right) == pytest.approx(0.15)
    assert [b.count for b in reliability(perfect, right)] == [1, 1, 1, 1]


def test_telling_classes_apart_is_no_merit() -> None:
    right = np.array([1.0] * 9 + [0.0] + [0.0] * 9 + [1.0])
    classes = np.array(["often"] * 10 + ["seldom"] * 10)
    stated = np.where(classes == "often", 0.9, 0.1)
    assert brier_skill(stated, right, classes) == pytest.approx(0.0)
    assert area_under_curve(stated, right, classes) == 0.5
