"""Going on where a run stopped, and adding later visits to a map."""

import json
import os
import shutil
import signal

import numpy as np
import pytest

from afkb.errors import MapError, PluginError, SourceError
from afkb.plugins.host import PluginHost
from afkb_mapping.localisation.localiser import Located
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.perception import Perception
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from afkb_mapping.visits.clock import clock_offset

WORLD = "world:two_rooms"
FRAMES = 5
OF_THE_RUN = {"run.json", "timings.js", "report.html"}


@pytest.fixture(scope="module")
def host():
    return PluginHost()


def asked(out, **more):
    wanted = {"uri": WORLD, "stop": FRAMES, "detectors": ("laser-bounds", "surfaces")}
    return Settings(out=out, **(wanted | more))


@pytest.fixture(scope="module")
def whole(host, tmp_path_factory):
    """A map in one go; to resume what is not there yet is to begin it."""
    out = tmp_path_factory.mktemp("whole") / "map"
    make_map(host, asked(out, resume=True))
    return out


@pytest.fixture(scope="module")
def left_off(host, tmp_path_factory):
    out = tmp_path_factory.mktemp("left-off") / "map"
    make_map(host, asked(out), interrupted_at(3))
    return out


def content(folder):
    files = (p for p in folder.rglob("*") if p.is_file() and p.name not in OF_THE_RUN)
    return {p.name: p.read_bytes() for p in files}


def interrupted_at(frame):
    def progress(so_far):
        if so_far.done == frame:
            os.kill(os.getpid(), signal.SIGINT)

    return progress


@pytest.fixture
def stopped(left_off, tmp_path):
    return shutil.copytree(left_off, tmp_path / "map")


def test_a_resumed_run_gives_the_map_of_one_go_to_the_byte(host, whole, stopped, monkeypatch):
    assert len(memory_of(stopped).views) == 3
    perceived, perceive = [], Perception.detections
    monkeypatch.setattr(
        Perception, "detections", lambda self, v: perceived.append(v.index) or perceive(self, v)
    )
    run = make_map(host, asked(stopped, resume=True)).run
    assert content(stopped) == content(whole)
    assert perceived == [3, 4]
    assert run["parameters"]["resume"] and run["frames"]["used"] == FRAMES


def test_a_run_is_resumed_as_it_was_begun_and_with_its_recording(host, stopped):
    before = content(stopped)
    with pytest.raises(MapError, match=r"was begun with stride 1, not 2"):
        make_map(host, asked(stopped, resume=True, stride=2))
    with pytest.raises(SourceError, match=r"frame 0 .* another recording"):
        make_map(host, asked(stopped, resume=True, uri="world:paper_home"))
    assert content(stopped) == before


def test_a_resumed_run_that_stops_earlier_than_before_loses_nothing(host, stopped):
    before = content(stopped)
    with pytest.raises(SourceError, match=r"stopped before the frame that .* ends with"):
        make_map(host, asked(stopped, resume=True), interrupted_at(2))
    assert content(stopped) == before


def test_a_map_of_a_mapper_without_memory_is_made_but_not_continued(host, tmp_path, monkeypatch):
    monkeypatch.setattr("afkb_observed_only.mapper.ObservedOnlyMapper.works_from_memory", False)
    out = tmp_path / "map"
    make_map(host, asked(out, stop=2, mapper="observed-only"))
    for how in ({"resume": True}, {"update": True}):
        with pytest.raises(PluginError, match="'observed-only' does not work from memory"):
            make_map(host, asked(out, mapper="observed-only", **how))
        with pytest.raises(MapError, match=r"it has no state/memory\.npz"):
            make_map(host, asked(out, **how))


class Elsewhere:
    """A localiser that knows a robot's place, or says that it is lost."""

    def __init__(self, answers):
        self._answers = iter(answers)

    def locate(self, views):
        x, y, yaw = next(self._answers, (np.nan,) * 3)
        return Located(bool(np.isnan(x)), x, y, yaw, 0.99, np.eye(3))


@pytest.fixture
def located(monkeypatch):
    def as_told(*answers):
        monkeypatch.setattr(
            "afkb_mapping.visits.arrival.localiser_of", lambda folder: Elsewhere(answers)
        )

    return as_told


def where(folder, *views):
    rows = np.loadtxt(folder / "state" / "trajectory.txt")
    return [(r[4], r[8], np.arctan2(r[5], r[1])) for r in rows[list(views)]]


def test_a_later_visit_adds_its_views_and_things_keep_their_names(host, whole, tmp_path, located):
    shutil.copytree(whole, tmp_path / "map")
    located(*where(whole, 2, 4))
    result = make_map(host, asked(tmp_path / "map", update=True, hours_later=2.0))
    memory = memory_of(tmp_path / "map")
    assert [p.visit for p in memory.passed] == [0] * FRAMES + [1] * FRAMES
    first, later = memory.passed[0], memory.passed[FRAMES]
    np.testing.assert_allclose(later.T_placed, first.T_placed, atol=0.03)
    assert later.stamp - memory.passed[FRAMES - 1].stamp == pytest.approx(7200)
    ids = [{n["id"] for n in nodes_of(folder)} for folder in (whole, tmp_path / "map")]
    assert ids[0] and ids[0] <= ids[1]
    assert [v["source"] for v in result.run["visits"]] == [WORLD, WORLD]
    assert result.run["visits"][1]["first_index"] > 0


def nodes_of(folder):
    told = json.loads((folder / "map.json").read_text())
    nodes = [n for room in told["rooms"] for n in room["objects"]] + told["elsewhere"]
    return [n for n in nodes if n["kind"] == "ObservedEntity"]


@pytest.mark.parametrize("answers", [(), ((0.0, 0.0, 0.0), (3.0, 1.0, 1.0), (-2.0, 4.0, 2.0))])
def test_a_visit_that_is_lost_leaves_the_map_as_it_was(host, stopped, located, answers):
    located(*answers)
    before = content(stopped)
    with pytest.raises(SourceError, match=r"can't be located in .*map it on its own with --out"):
        make_map(host, asked(stopped, update=True))
    assert content(stopped) == before


@pytest.mark.parametrize(
    ("last", "first", "hours", "gap", "noted"),
    [
        (90.0, 0.0, None, 86400.0, True),
        (90.0, 0.0, 0.5, 1800.0, False),
        (90.0, 1.7e9, None, 86400.0, True),
        (1.7e9, 1.7e9 + 5, None, 5.0, False),
        (1.7e9, 1.6e9, None, 86400.0, True),
    ],
)
def test_the_time_between_visits(last, first, hours, gap, noted):
    offset, note = clock_offset(last, first, hours)
    assert first + offset - last == pytest.approx(gap)
    assert (note is not None) == noted
