"""Surfaces and containers in a recorded home, held against its truth."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from afkb.plugins.host import PluginHost
from bench.detectors import containers, surfaces
from bench.detectors.data import Home


@pytest.fixture(scope="module")
def scored(data_dir: Path) -> dict[str, Any]:
    home = data_dir / "homes" / "merom"
    if not home.is_dir():
        pytest.skip(f"no recording at {home}")
    seen = Home(home, PluginHost(), 6, ("surfaces", "things", "containers"))
    return {
        "supports": surfaces.score(seen.seen, seen.truth),
        "containers": containers.scored(seen),
    }


def test_supports_are_found_at_their_height_and_nowhere_else(scored: dict[str, Any]) -> None:
    supports = scored["supports"]
    assert supports["recall"] >= 0.75
    assert supports["precision"] >= 0.95
    assert supports["height_error_median_m"] <= 0.003
    assert supports["height_error_p90_m"] <= 0.010


def test_what_is_taken_for_a_container_is_one(scored: dict[str, Any]) -> None:
    hollow, closed = scored["containers"]["hollow"], scored["containers"]["closed"]
    assert hollow["view_claims"] + closed["view_claims"] >= 5
    assert hollow["view_precision"] >= 0.9
    assert closed["view_precision"] >= 0.75
