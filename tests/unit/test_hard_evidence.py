"""Bad evidence and odd extensions have a clear answer or a clear error."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from afkb.errors import EvidenceError, KnowledgeError
from afkb.inference import Network
from afkb.knowledge import AfNet
from bench.inference.hardships import CIRCLES, crowd, crowded, many_categories

CONTRADICTIONS = [
    {"BedSupport": 10**9, "LargeContainer": 10**9, "DisplaySurface": 10**9},
    {"BedSupport": 40, "CounterHeightSupport": 0},
]


@pytest.fixture(scope="module")
def network() -> Network:
    return Network.compile(AfNet())


@pytest.mark.parametrize("p", [0.0, 1.0])
def test_a_thing_that_affords_all_or_nothing_has_a_posterior(network: Network, p: float) -> None:
    every = dict.fromkeys(network.knowledge_base.features, p)
    posterior = network.category_posterior(every, (0.2, 0.2, 0.2), 1.0)
    assert math.fsum(posterior.values()) == pytest.approx(1.0, abs=1e-9)
    assert min(posterior.values()) >= 0


def test_a_thing_of_no_possible_size_is_hardly_furniture(network: Network) -> None:
    posterior = network.category_posterior({"SupportAbility": 1.0}, (1e4, 1e4, 1e4), 1e4)
    assert math.fsum(posterior.values()) == pytest.approx(1.0, abs=1e-9)
    assert posterior["Table"] < 0.01


@pytest.mark.parametrize("counts", CONTRADICTIONS)
def test_contradictory_counts_have_a_posterior(network: Network, counts: dict[str, int]) -> None:
    posterior = network.room_posterior(counts)
    assert math.fsum(posterior.values()) == pytest.approx(1.0, abs=1e-9)
    assert all(math.isfinite(p) and p >= 0 for p in posterior.values())


@pytest.mark.parametrize("count", [-1, 0.5, math.nan, math.inf])
def test_a_bad_count_is_told_by_name(network: Network, count: float) -> None:
    with pytest.raises(EvidenceError, match="BedSupport has count"):
        network.room_posterior({"BedSupport": count})  # type: ignore[dict-item]


def test_categories_in_a_circle_are_refused_with_the_line(tmp_path: Path) -> None:
    path = tmp_path / "hard.yaml"
    path.write_text(f"extension: hard\n{CIRCLES['categories broader than each other']}")
    with pytest.raises(KnowledgeError, match=r"line 4: Kiosk is broader than itself"):
        AfNet(extensions=[path]).categories  # noqa: B018


def test_predictions_may_go_in_a_circle(tmp_path: Path) -> None:
    path = tmp_path / "hard.yaml"
    circle = CIRCLES["co-occurrences in a circle"]
    path.write_text(f"extension: hard\n{circle}{many_categories(30)}")
    network = Network.compile(AfNet(extensions=[path]))
    posterior = network.category_posterior({"SupportAbility": 0.9}, (1.4, 0.8, 0.04), 0.73)
    assert {"Table", "Thing29"} <= set(posterior)
    assert math.fsum(posterior.values()) == pytest.approx(1.0, abs=1e-9)
    assert network.room_posterior({"SeatHeightSupport": 4}).keys() == AfNet().rooms.keys()


def test_a_room_of_two_thousand_things_has_a_purpose(network: Network) -> None:
    grid, evidence = crowded(network, crowd())
    room = np.ones(grid.probability.shape, dtype=bool)
    assert sum(evidence.counts(room).values()) >= 2000
    assert math.fsum(evidence.posterior(room).values()) == pytest.approx(1.0, abs=1e-9)
