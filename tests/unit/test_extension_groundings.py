"""Groundings that an extension states: read as they stand, and refused where nothing measures."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.knowledge import AfNet
from extension_samples import problems, yaml_file

STEP = """features:
  StepAbility:
    kind: structural
    definition: One can step up on it.
    grounded_on: surface
    parameters:
      height_m: [0.1, 0.15, 0.3, 0.4]
"""
REFUSED = {
    "an unknown measure": (
        STEP.replace("height_m", "hight_m"),
        "home.yaml, line 8: StepAbility: nothing measures hight_m; did you mean height_m",
    ),
    "a measure that surfaces don't have": (
        STEP.replace("height_m", "depth_m"),
        "StepAbility: depth_m is no measure of a surface, only of: body, opening",
    ),
    "something nothing is grounded on": (
        STEP.replace("grounded_on: surface", "grounded_on: ceiling"),
        "grounded_on",
    ),
}


def test_a_feature_is_grounded_by_measures_where_it_says_on_what(tmp_path: Path) -> None:
    base = AfNet.load(extensions=[yaml_file(tmp_path, STEP)])
    step = base.features["StepAbility"]
    assert (step.grounded_by, step.grounded_on) == (("measures",), ("surface",))
    assert step.grounding_strength == 0.8
    assert not step.is_weak


def test_a_measure_of_ones_own_may_be_asked_for(tmp_path: Path) -> None:
    measure = """measures:
  WobbleMeasure: {definition: How far it gives way., measure_name: wobble_m, measure_of: surface}
"""
    base = AfNet.load(
        extensions=[yaml_file(tmp_path, STEP.replace("height_m", "wobble_m") + measure)]
    )
    assert base.measures["wobble_m"].measure_of == ("surface",)


@pytest.mark.parametrize(("text", "says"), REFUSED.values(), ids=REFUSED.keys())
def test_it_is_told_in_a_line(text: str, says: str, tmp_path: Path) -> None:
    (line,) = problems(yaml_file(tmp_path, text))
    assert says in line


def test_every_bundled_range_is_of_what_its_feature_is_grounded_on() -> None:
    base = AfNet()
    for feature in base.features.values():
        for name in feature.parameters:
            for subject in feature.grounded_on:
                assert subject in base.measures[name].measure_of, (feature.name, name)
        assert not feature.is_weak or feature.grounding_strength < 0.5, feature.name
        assert not feature.is_weak or feature.grounding_reason, feature.name
        assert feature.grounded_by, feature.name
