"""Homes of one's own refit how many rooms a home has, and what is counted in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.inference import Network
from afkb.knowledge import AfNet
from afkb.knowledge.own_homes import classes_of

W = 8
"""Homes, or rooms, that the ontology's figures count for."""
SEATS = "SeatHeightSupport"


@pytest.fixture(scope="module")
def kb() -> AfNet:
    return AfNet()


@pytest.fixture
def mine(tmp_path: Path) -> AfNet:
    (tmp_path / "homes.csv").write_text(
        "building,room,category,objects\n"
        + "".join(f"flat-{i},r1,bathroom,chair:6|mug:1\n" for i in range(4))
    )
    (tmp_path / "mine.yaml").write_text("extension: mine\nhomes: [homes.csv]\n")
    return AfNet(extensions=[tmp_path / "mine.yaml"])


@pytest.mark.parametrize(
    ("category", "class_name"),
    [("Chair", SEATS), ("Bed", "BedSupport"), ("Mug", "SmallContainer")],
)
def test_a_typical_thing_counts_for_its_class(kb: AfNet, category: str, class_name: str) -> None:
    found = classes_of(kb.categories[category], kb.evidence_classes, kb.features)
    assert class_name in found


def test_counts_and_numbers_are_means_about_those_that_the_ontology_states(
    kb: AfNet, mine: AfNet
) -> None:
    before, after = kb.rooms["Bathroom"], mine.rooms["Bathroom"]
    assert after.expected_counts[SEATS] == pytest.approx(
        (W * before.expected_counts[SEATS] + 24) / (W + 4)
    )
    assert after.expected_number == pytest.approx((W * before.expected_number + 4) / (W + 4))
    assert mine.rooms["Kitchen"].expected_counts == kb.rooms["Kitchen"].expected_counts
    assert mine.rooms["UnknownRoom"] == kb.rooms["UnknownRoom"]


def test_a_room_like_ones_own_is_told_as_one(kb: AfNet, mine: AfNet) -> None:
    evidence = {SEATS: 6}
    before, after = (Network.compile(k).room_posterior(evidence)["Bathroom"] for k in (kb, mine))
    assert after > 2 * before
