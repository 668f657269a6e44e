"""What the benchmark of containers counts as found, and as wrong."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from afkb.flow import Detection, OrientedBox
from bench.detectors.containers import score
from bench.detectors.in_sight import pixels_in_sight
from bench.detectors.seen import Run
from depth_samples import FLOOR, Box, table, view_of


def claim(x: float, closed: bool = False) -> Detection:
    affordances = {"ContainAbility": 0.8} | ({"IntrinsicContainAbility": 0.8} if closed else {})
    at = np.array([x, 0.0, 0.5])
    box = OrientedBox((x, 0.0, 0.5), (0.08, 0.08, 0.1))
    return Detection("d", affordances, box, at, np.eye(3), at[None, :2], 700, 1.0)


def thing(name: str, x: float, category: str) -> dict[str, Any]:
    low, high = [x - 0.04, -0.04, 0.45], [x + 0.04, 0.04, 0.55]
    return {"name": name, "category": category, "min": low, "max": high, "most_pixels": 900}


TRUTH = {"things": [thing("mug", 1.0, "025_mug"), thing("can", 2.0, "002_can")]}
WELL = {"mug": {0: 900, 1: 800}, "can": {0: 700, 1: 200}}


def test_a_thing_is_found_where_two_views_claim_it_or_all_that_see_it_well() -> None:
    once = Run([(0, [claim(1.0), claim(2.0, closed=True)]), (1, [])])
    result = score(once, TRUTH, WELL)
    assert result["hollow"]["recall"] == 0.0
    assert result["closed"]["recall"] == 1.0
    twice = Run([(0, [claim(1.0)]), (1, [claim(1.0)])])
    assert score(twice, TRUTH, WELL)["hollow"]["recall"] == 1.0


def test_a_place_is_false_where_two_views_claim_what_is_no_container() -> None:
    run = Run([(0, [claim(3.0), claim(4.0)]), (1, [claim(3.05)])])
    hollow = score(run, TRUTH, WELL)["hollow"]
    assert hollow["false"] == 1
    assert hollow["view_claims"] - hollow["view_right"] == 3


def test_an_opening_claimed_of_a_closed_thing_is_wrong() -> None:
    result = score(Run([(0, [claim(2.0)]), (1, [claim(2.0)])]), TRUTH, WELL)
    assert result["hollow"]["view_precision"] == 0.0
    assert result["closed"]["recall"] == 0.0


def test_pixels_in_sight_are_those_of_the_thing_alone() -> None:
    low, high = (1.15, -0.05, 0.73), (1.23, 0.05, 0.90)
    things = [{"name": "carton", "min": low, "max": high}]
    alone = pixels_in_sight([view_of([FLOOR, Box(low, high)])], things)["carton"][0]
    scene = [FLOOR, table(1.3, 0.0, 0.73), Box(low, high)]
    assert pixels_in_sight([view_of(scene)], things)["carton"][0] == pytest.approx(alone, rel=0.05)
