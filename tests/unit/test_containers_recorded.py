"""Surfaces and containers in a recorded home, held against its truth."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from afkb.plugins.host import PluginHost
from bench.detectors import placed_views, run_detectors, score


@pytest.fixture(scope="module")
def scored(data_dir: Path) -> dict[str, Any]:
    home = data_dir / "homes" / "merom"
    if not home.is_dir():
        pytest.skip(f"no recording at {home}")
    host = PluginHost()
    truth = json.loads((home / "truth.json").read_text())
    views = placed_views(host.open_source(str(home / "bag")).views(stride=6), truth)
    return score(run_detectors(views, host.detectors(["surfaces", "containers"])), truth)


def test_supports_are_found_at_their_height_and_nowhere_else(scored: dict[str, Any]) -> None:
    supports = scored["supports"]
    assert supports["recall"] >= 0.75
    assert supports["precision"] >= 0.95
    assert supports["height_error_median_m"] <= 0.003
    assert supports["height_error_p90_m"] <= 0.010


def test_what_is_taken_for_a_container_is_one(scored: dict[str, Any]) -> None:
    containers = scored["containers"]
    assert containers["claims"] >= 8
    assert containers["precision"] >= 0.9
