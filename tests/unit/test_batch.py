"""A batch: what maps are called, what is done already, and what one can't do to others."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from afkb.errors import MapError, SourceError
from afkb.store import write_map
from afkb.store.made_with import ontology_record
from afkb_mapping.batch import watched
from afkb_mapping.batch.done import to_do
from afkb_mapping.batch.job import Job, JobState
from afkb_mapping.batch.recordings import recordings
from afkb_mapping.batch.running import Batch
from afkb_mapping.batch.sharing import SchedulerError, outcomes
from afkb_mapping.run_record import Settings
from store_samples import Names, sample_map


def test_maps_are_called_what_their_recordings_are(tmp_path):
    for path in ("a/bag", "b/bag", "c/tour one", "drive.2024.log", "flat.world.yaml"):
        (tmp_path / path).mkdir(parents=True)
    found = recordings([f"{tmp_path}/*/bag", f"{tmp_path}/c/tour one", "world:paper_home"])
    assert list(found) == ["a-bag", "b-bag", "tour-one", "paper_home"]
    assert found["a-bag"] == str(tmp_path / "a/bag") and found["paper_home"] == "world:paper_home"
    listed = ["# two", "", f"{tmp_path}/drive.2024.log", f"home={tmp_path}/flat.world.yaml # x"]
    assert set(recordings([], listed)) == {"drive.2024", "home"}


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nothing-*-here"], "no file or folder"),
        (["a=x", "a=y"], "called 'a' already"),
        (["x", "b=x"], "named twice"),
        (["home", "home=y"], "write NAME=home"),
        (["x.log", "x.bag"], "NAME=x.log"),
    ],
)
def test_recordings_that_cant_be_told_apart_are_refused(arguments, told):
    with pytest.raises(SourceError, match=told):
        recordings(arguments)


def job(folder: Path, **changes: object) -> Job:
    settings = Settings(uri="/bags/home", out=folder, stride=2, options={"a": "b"})
    return Job("home", replace(settings, **changes))  # type: ignore[arg-type]


def test_a_job_is_the_same_in_another_process(tmp_path):
    asked = replace(job(tmp_path, detectors=("surfaces",)), ontology=(Path("/x.yaml"),))
    assert Job.from_json(json.loads(json.dumps(asked.as_json()))) == asked


RECORD = [{"file": "/afnet.owl", "sha256": "5"}]


def made(folder: Path, asked: Job, **more: object) -> None:
    names = ("detectors", "predictors", "mapper", "rule", "start", "stop", "stride", "options")
    parameters = {name: getattr(asked.settings, name) for name in names} | {"resume": False}
    run = {"source": asked.settings.uri, "parameters": parameters, "ontology": RECORD, **more}
    write_map(folder, sample_map(), run, [], Names())


def test_what_is_mapped_is_not_mapped_again_unless_something_differs(tmp_path):
    folder = tmp_path / "home"
    asked = job(folder)
    assert to_do(asked, RECORD) == asked
    made(folder, asked)
    assert to_do(asked, RECORD) is None
    assert to_do(asked, [{"file": "/afnet.owl", "sha256": "6"}]) == asked
    with pytest.raises(MapError, match="made with stride 2, not 3"):
        to_do(job(folder, stride=3), RECORD)
    with pytest.raises(MapError, match=r"is a map of /bags/home; call this one otherwise"):
        to_do(job(folder, uri="/bags/other"), RECORD)
    made(folder, asked, interrupted_by="SIGTERM")
    again = to_do(asked, RECORD)
    assert again is not None and again.settings.resume


@pytest.fixture
def odd_runner(monkeypatch):
    monkeypatch.setattr(watched, "RUNNER", "odd_runner")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("is-killed", "its process was ended by SIGKILL; was memory short?"),
        ("grows", "took more than 100 MB of memory and was stopped"),
        ("sleeps", r"took more than 0.5 s and was stopped"),
        ("babbles", "ended without a result .*all went well"),
        ("raises", "ended with code 1: no such pumpkin"),
    ],
)
def test_whatever_a_process_does_is_told_in_a_line(odd_runner, tmp_path, name, told):
    seconds = 0.5 if name == "sleeps" else 30
    asked = replace(job(tmp_path), name=name, seconds=seconds)
    found = watched.mapped(asked, memory_limit=100_000_000)
    assert found.state is JobState.FAILED
    assert found.error is not None
    assert re.search(told, found.error), found.error


def test_the_figures_of_a_map_are_told(odd_runner, tmp_path):
    found = watched.mapped(replace(job(tmp_path), threads=3))
    assert (found.state, found.frames, found.things) == (JobState.MAPPED, 7, 3)
    assert set(json.loads(json.dumps(found.as_json()))) >= {
        "name",
        "source",
        "map",
        "state",
        "error",
        "stored",
    }


def test_a_scheduler_that_is_not_there_is_told_of(tmp_path, monkeypatch):
    monkeypatch.setattr("afkb_mapping.batch.sharing.CONNECT_WITHIN_S", 0.3)
    with pytest.raises(SchedulerError, match="no Dask scheduler answers there"):
        list(outcomes([job(tmp_path)], 1, scheduler="tcp://127.0.0.1:9"))


def test_a_damaged_map_among_those_that_are_there_stops_no_other(tmp_path):
    batch = Batch([(n, Settings("world:paper_home", tmp_path / n)) for n in ("good", "damaged")])
    record = ontology_record(batch.knowledge_base.files)
    asked = {"stride": 1, "start": 0, "stop": None}
    run = {"source": "world:paper_home", "parameters": asked, "ontology": record}
    for name, _ in batch.settings:
        write_map(tmp_path / name, sample_map(), run, [], Names())
    (tmp_path / "damaged" / "scene.ttl").write_text("<x> <y>")
    batch.run(resume=True)
    states = {outcome.name: outcome.state for outcome in batch.outcomes}
    assert states == {"good": JobState.SKIPPED, "damaged": JobState.FAILED}
