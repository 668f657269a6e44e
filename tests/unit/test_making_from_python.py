"""Maps made from Python: with parts of one's own, gone on with, travelled and compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from afkb.errors import PluginError, RouteError
from afkb.flow import Detection, View
from afkb_mapping.api import changes, map_recording, route, search, update_map


class Everything:
    """Says of every support that one can climb on it."""

    name = "everything"
    affordances = ("StepAbility",)
    stage = 1

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        return [
            replace(d, detector=self.name, affordances={"StepAbility": 0.9}, about=i)
            for i, d in enumerate(earlier)
            if d.affords("SupportAbility")
        ]


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made") / "home"
    made = map_recording("world:two_rooms", folder, add=[Everything()], stop=5)
    assert any("StepAbility" in node["affords"] for node in made.nodes())
    return folder


def test_a_later_visit_is_added_and_compared(home: Path, tmp_path: Path) -> None:
    import shutil

    later = shutil.copytree(home, tmp_path / "later")
    updated = update_map(
        later, "world:two_rooms", add=[Everything()], start=1, stop=5, hours_later=24
    )
    assert updated.folder == later
    assert changes(home, later).unchanged


def test_ways_and_searches_lead_somewhere(home: Path) -> None:
    assert route(home, "0,0", "0.5,0").length == pytest.approx(0.5, abs=0.1)
    places = search(home, "0,0", "chair").places
    assert places and all(0 < place.probability <= 1 for place in places)
    with pytest.raises(RouteError, match="is a place, not a kind of thing"):
        search(home, "0,0", "0.5,0")


def test_what_is_no_part_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PluginError, match="no detector, predictor, room classifier"):
        map_recording("world:two_rooms", tmp_path / "x", add=[object()])
    assert not (tmp_path / "x").exists()
