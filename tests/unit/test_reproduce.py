"""The paper's scenarios are judged rightly: by truths that were made up, on maps that were, too."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.errors import SourceError
from afkb.flow import OccupancyGrid, OrientedBox, Room, TopologicalMap, TrueThing, TrueView, Truth
from afkb.plugins import hookimpl
from afkb.plugins.host import PluginHost
from afkb.store.stored_grid import StoredGrid
from afkb.testing import sample_map
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_paper.judged import Judged, return_errors, stays
from afkb_paper.moving import nodes_at
from afkb_paper.passing import points_around, ways_between
from afkb_paper.rooms import AFFORDANCES, judged_rooms
from afkb_paper.rows import Outcome, rows
from afkb_paper.scenarios import SCENARIOS, sources
from afkb_paper.truth_file import truth_of

HOST = PluginHost()
WAY = ((0.0, 0.0, "a"), (2.0, 0.0, None), (4.0, 0.0, "b"), (2.0, 0.0, None), (0.0, 0.5, "a"))


def true_views(
    turned: float = 0.0, moved: tuple[float, float] = (0.0, 0.0)
) -> tuple[TrueView, ...]:
    c, s = math.cos(turned), math.sin(turned)
    return tuple(
        TrueView(float(i), c * x - s * y + moved[0], s * x + c * y + moved[1], turned, room)
        for i, (x, y, room) in enumerate(WAY)
    )


def mapped(drift_m: float = 0.0) -> TopologicalMap:
    """The way as a map has it that drifts along y with every view."""
    poses = [T_from_xy_yaw(x, y + i * drift_m, 0.0) for i, (x, y, _) in enumerate(WAY)]
    way = np.array([[i, *T.ravel()] for i, T in enumerate(poses)])
    halves = ((-1.0, "Kitchen", 0.9), (3.0, "ChildsRoom", 0.8))
    found = [
        Room(
            f"room-{i}",
            x,
            0.0,
            16.0,
            np.array([[x, -2], [x + 3.5, -2], [x + 3.5, 2], [x, 2]]),
            {purpose: p, "UnknownRoom": 1 - p},
            other_beliefs={"doors-and-walls": {"Kitchen": 0.6, "Bedroom": 0.4}},
        )
        for i, (x, purpose, p) in enumerate(halves)
    ]
    return replace(sample_map(), trajectory=way, rooms=tuple(found))


def test_frames_are_laid_on_each_other_wherever_the_truth_has_its_origin() -> None:
    truth = Truth(true_views(1.2, (5.0, -3.0)))
    judged = Judged.of(mapped(), truth)
    assert max(off for _, off, _ in judged.views()) < 1e-9
    assert max(turn for _, _, turn in judged.views()) < 1e-9


def test_the_loop_error_is_that_of_views_in_rooms_that_were_left_before() -> None:
    judged = Judged.of(mapped(drift_m=0.1), Truth(true_views()))
    assert [room for room, _ in stays(judged.truth)] == ["a", "b", "a"]
    assert return_errors(judged) == pytest.approx([0.4])


def test_a_map_of_another_recording_is_not_judged() -> None:
    with pytest.raises(SourceError, match="of this recording"):
        Judged.of(mapped(), Truth((TrueView(99.0, 0, 0, 0),)))


def test_rooms_are_right_by_each_classifier_on_its_own() -> None:
    truth = Truth(true_views(), (), {"a": "Kitchen", "b": "ChildsRoom"})
    a, b = judged_rooms(mapped(), truth)
    assert (a.is_right(AFFORDANCES), b.is_right(AFFORDANCES)) == (True, True)
    assert (a.is_right("doors-and-walls"), b.is_right("doors-and-walls")) == (True, False)
    assert b.right == {"ChildsRoom", "Bedroom"}
    assert a.told("nobody") is None


def test_the_table_tells_what_falls_short() -> None:
    truth = Truth(true_views(), (), {"a": "Bathroom", "b": "Bedroom"})
    judged = Judged.of(mapped(drift_m=0.1), truth)
    outcome = Outcome(judged, judged_rooms(judged.found, truth), [], [], "no way to it")
    told = {row.key: row for row in rows(SCENARIOS[1].paper, outcome)}
    assert (told["places"].paper, told["places"].ours) == ("8", "1")
    assert told["rooms"].ours == "0/2"
    assert "a: Kitchen" in told["rooms"].how
    assert told["loop_error"].value == {"greatest": 0.4, "mean": 0.4}
    assert told["mug"].ours == "no route" and "no way to it" in told["mug"].how
    assert json.dumps([row.value for row in told.values()])


def grid(blocked: float) -> OccupancyGrid:
    """Free all around, with a block in the middle of which this probability is told."""
    p = np.full((80, 80), 0.05, np.float32)
    p[30:50, 30:50] = blocked
    return OccupancyGrid(p, 0.05, (-2.0, -2.0))


def test_ways_lead_round_what_is_expected_and_through_what_nobody_knows() -> None:
    table = shapely.box(-0.5, -0.5, 0.5, 0.5)
    stood = np.array([[-1.5, 0.0], [-1.45, 0.0], [1.5, 0.0], [0.0, 1.5], [9.0, 9.0]])
    points = points_around(table, stood)
    assert len(points) == 3
    stored = StoredGrid(grid(0.05), 0.2, 0.65)
    blind = ways_between(points, grid(np.nan), stored, table)
    expecting = ways_between(points, grid(0.7), stored, table)
    assert (blind.hits, expecting.hits) == (1, 0)
    assert max(blind.within_m) == pytest.approx(1.4, abs=0.06)


def test_a_node_that_says_that_a_thing_still_stands_there_is_found() -> None:
    found = sample_map()
    there, elsewhere = (OrientedBox((x, 0.0, 0.4), (0.8, 1.2, 0.8)) for x in (1.8, -3.0))
    assert [e.id for e in nodes_at(found, there)] == ["thing-1"]
    assert nodes_at(found, elsewhere) == []


TOLD = {
    "views": [
        {"stamp": 0.5, "x": 1, "y": 2, "yaw": 0.1, "room": "kitchen_0"},
        {"stamp": 1.0, "x": 1, "y": 2, "yaw": 0.1, "room": "broom_closet_9"},
    ],
    "things": [
        {
            "name": "mug_1",
            "category": "mug",
            "room": "kitchen_0",
            "min": [0, 0, 0],
            "max": [1, 2, 3],
        }
    ],
}


def test_a_truth_file_is_told_in_the_ontologys_words() -> None:
    truth = truth_of(TOLD)
    assert truth.rooms["kitchen_0"] == "Kitchen"
    box = OrientedBox((0.5, 1.0, 1.5), (1.0, 2.0, 3.0))
    assert truth.things == (TrueThing("mug_1", "Mug", box, "kitchen_0"),)


@pytest.mark.parametrize("called", ["mug", "025_mug", "065-f_cups"])
def test_numbers_of_a_catalogue_are_no_part_of_a_category(called: str) -> None:
    thing = TOLD["things"][0] | {"category": called}
    truth = truth_of({"views": [], "things": [thing]})
    assert truth.things[0].category in {"Mug", "Cup"}


def test_the_truth_of_a_recording_lies_beside_it(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    assert HOST.truth(str(tmp_path / "bag")) is None
    (tmp_path / "truth.json").write_text(json.dumps(TOLD))
    truth = HOST.truth(str(tmp_path / "bag"))
    assert truth is not None and len(truth.views) == 2
    (tmp_path / "truth.json").write_text('{"views": [{}]}')
    with pytest.raises(SourceError, match="no truth of a home"):
        HOST.truth(str(tmp_path / "bag"))


def test_a_world_tells_when_things_were_taken_away() -> None:
    truth = HOST.truth("world:two_rooms")
    assert truth is not None
    until = {thing.name: thing.until for thing in truth.things}
    assert until["table"] == math.inf
    assert 0 < until["ball"] < truth.views[-1].stamp
    assert truth.rooms == {"kitchen": "Kitchen", "hall": "LivingRoom"}


def test_each_scenario_gets_the_home_with_most_nearly_its_rooms(tmp_path: Path) -> None:
    for name, rooms in (("large", 6), ("middling", 4), ("small", 2)):
        (tmp_path / name / "bag").mkdir(parents=True)
        views = [{"stamp": i, "x": 0, "y": 0, "yaw": 0, "room": f"r_{i}"} for i in range(rooms)]
        told = json.dumps({"views": views, "things": []})
        (tmp_path / name / "truth.json").write_text(told)
    chosen = [Path(uri).parent.name for uri in sources(tmp_path, HOST).values()]
    assert chosen[1:] == ["middling", "small"]
    assert sources(tmp_path, HOST)[SCENARIOS[0]] == "world:paper_home"
    assert set(sources(None, HOST).values()) == {s.world for s in SCENARIOS}


class Surveyor:
    """A plugin that knows what is so in one recording."""

    @hookimpl
    def afkb_truth(self, uri: str) -> Truth | None:
        return Truth(true_views()) if uri == "survey:home" else None


def test_a_stranger_may_know_the_truth() -> None:
    host = PluginHost()
    host.register(Surveyor())
    truth = host.truth("survey:home")
    assert truth is not None and len(truth.views) == len(WAY)
    assert host.truth("survey:elsewhere") is None


def test_bad_input_is_one_line() -> None:
    with pytest.raises(SourceError, match="--data"):
        sources(Path("/nowhere"), HOST)
    assert CliRunner().invoke(build_cli(HOST), ["reproduce", "--scenario", "4"]).exit_code == 2
