from __future__ import annotations

import dataclasses
import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from pyoxigraph import NamedNode

import afkb.store.folder as folder_module
from afkb.errors import MapError
from afkb.flow import NodeKind
from afkb.store import check_out, load, write_map
from afkb.store.shapes import info_json, nodes_json, rooms_json
from afkb.store.vocabulary import AFN
from afkb_nav2.exporter import Nav2Exporter
from afkb_report.exporter import ReportExporter
from store_samples import Names, entity, sample_map

EXPORTERS = [Nav2Exporter(), ReportExporter()]


def write(folder: Path, **changes: object) -> Path:
    changed = dataclasses.replace(sample_map(), **changes)
    return write_map(folder, changed, {"seconds": {"read": 0.1}}, EXPORTERS, Names())


def files_of(folder: Path) -> dict[str, bytes]:
    return {
        p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("maps") / "home")


def test_a_map_folder_has_every_file_of_the_contract(folder: Path) -> None:
    names = {"scene.ttl", "map.json", "occupancy.pgm", "occupancy.yaml", "report.html", "run.json"}
    assert names <= set(files_of(folder))
    assert (folder / "state").is_dir()
    run = json.loads((folder / "run.json").read_text())
    assert np.array(run["T_map_source"]).shape == (4, 4)


def test_what_was_written_is_read_back(folder: Path) -> None:
    nodes = {node["id"]: node for node in nodes_json(load(folder))}
    assert list(nodes) == ["p1", "p2", "n1", "n2", "n10", "n3"]
    mug = nodes["n2"]
    assert (mug["x"], mug["y"], mug["z"]) == (2.1, 1.1, 0.78)
    assert mug["size"] == [0.09, 0.08, 0.1]
    assert mug["affords"] == ["ContainAbility"]
    assert mug["category"] == {"Mug": 0.6, "Bowl": 0.3, "SomethingElse": 0.1}
    assert (mug["room"], mug["supported_by"]) == ("room1", "n1")
    assert (mug["movability"], mug["matching_weight"]) == ("Dynamic", 0.3)
    assert nodes["n3"]["predicted_from"] == ["n2"]
    assert nodes["n1"]["predicted_first"] == "DualPrediction"


def test_a_prediction_tells_its_region_and_its_life(folder: Path) -> None:
    stored = load(folder)
    (desk,) = stored.instances("CoOccurrencePrediction")
    parts = [p for p in stored.values(desk, "afn:regionPart") if isinstance(p, NamedNode)]
    assert sum(stored.number(p, "afn:probability") for p in parts) == pytest.approx(1)
    assert stored.name(desk, "afn:regionRelation") == "near"
    assert stored.name(desk, "afn:predictionState") == "Predicted"
    (made,) = stored.values(desk, "afn:change")
    assert isinstance(made, NamedNode)
    assert stored.name(made, "afn:changeKind") == "Predicted"
    assert stored.names(made, "afn:byEntity") == ["n2"]


def test_a_prediction_that_ended_is_told_and_is_no_node(folder: Path) -> None:
    told = info_json(load(folder))
    (past,) = told["past_predictions"]
    assert (past["id"], past["state"], past["seen_as"]) == ("n4", "Confirmed", "n1")
    assert past["probability"] == 0.7
    assert "n4" not in {node["id"] for node in told["nodes"]}


def test_what_affords_nothing_for_sure_affords_its_likeliest(folder: Path) -> None:
    nodes = {node["id"]: node for node in nodes_json(load(folder))}
    assert nodes["n10"]["affords"] == ["SupportAbility"]
    assert nodes["n10"]["extent_known"] is False


def test_rooms_are_read_back_with_posterior_and_outline(folder: Path) -> None:
    first, second = rooms_json(load(folder))
    assert first["belief"] == {"Kitchen": 0.7, "UnknownRoom": 0.3}
    assert first["area"] == 8.0
    assert len(first["polygon"]) == 4
    assert (second["id"], second["visited"]) == ("room2", False)


def test_what_others_make_of_a_room_and_its_second_purpose_are_read_back(folder: Path) -> None:
    first, second = rooms_json(load(folder))
    assert first["other_beliefs"] == {"by-colour": {"UnknownRoom": 0.75, "Bedroom": 0.25}}
    assert first["second_purpose"] == {"category": "DiningRoom", "probability": 0.9}
    assert (second["other_beliefs"], second["second_purpose"]) == ({}, None)


def test_info_counts_kinds_closures_and_notes(folder: Path) -> None:
    info = info_json(load(folder))
    assert info["kinds"]["ObservedEntity"] == 3
    assert info["kinds"]["Edge"] == 3
    assert info["counts"] == {"frames": 41, "skipped_frames": 1}
    assert info["closures"][0]["node"] == "n1"
    assert info["closures"][0]["displacement"] == 0.12
    assert "almost no depth" in info["notes"][0]


def test_scene_has_no_blank_nodes_and_meets_the_contract_through_rdflib(folder: Path) -> None:
    import rdflib

    graph = rdflib.Graph().parse(folder / "scene.ttl")
    afn = rdflib.Namespace(AFN)
    assert not {n for t in graph for n in t if isinstance(n, rdflib.BNode)}
    for kind in ("ObservedEntity", "CoOccurrencePrediction"):
        for node in graph.subjects(rdflib.RDF.type, afn[kind]):
            existence = graph.value(node, afn.existence)
            assert existence.datatype == rdflib.XSD.double
            assert 0 <= float(existence) <= 1
            assert set(graph.objects(node, afn.affords))
    for room in graph.subjects(rdflib.RDF.type, afn.Room):
        total = sum(
            float(graph.value(b, afn.probability)) for b in graph.objects(room, afn.roomBelief)
        )
        assert total == pytest.approx(1.0)
    assert len(graph) == len(load(folder).graph)


def test_map_json_lists_objects_by_room_in_under_a_kilobyte_each(folder: Path) -> None:
    whole = json.loads((folder / "map.json").read_text())
    by_room = {room["id"]: [o["id"] for o in room["objects"]] for room in whole["rooms"]}
    assert by_room == {"room1": ["n1", "n2", "n3"], "room2": []}
    assert [o["id"] for o in whole["elsewhere"]] == ["n10"]
    lines = (folder / "map.json").read_text().splitlines()
    assert max(len(line) for line in lines if "kind" in line) < 1024


def test_the_same_map_gives_the_same_bytes_in_another_process(folder: Path, tmp_path: Path) -> None:
    here = Path(__file__).parent
    code = (
        f"import sys; sys.path.insert(0, {str(here)!r})\n"
        "from test_store_roundtrip import write; from pathlib import Path\n"
        f"write(Path({str(tmp_path / 'again')!r}))"
    )
    subprocess.run(
        [sys.executable, "-c", code], check=True, env={**os.environ, "PYTHONHASHSEED": "7"}
    )
    first, second = files_of(folder), files_of(tmp_path / "again")
    first.pop("run.json"), second.pop("run.json")
    assert first == second


def test_different_maps_have_different_names_for_their_things(folder: Path, tmp_path: Path) -> None:
    other = write(tmp_path / "other", notes=("another visit",))
    assert load(other).base != load(folder).base


def test_an_update_keeps_the_names_and_the_state(tmp_path: Path) -> None:
    whole = sample_map()
    first = write_map(tmp_path / "m", whole, {}, EXPORTERS, Names(), state={"keys/a.bin": b"a"})
    base = load(first).base
    changed = dataclasses.replace(whole, notes=("later",))
    write_map(first, changed, {}, EXPORTERS, Names(), update=True, state={"b.bin": b"b"})
    assert load(first).base == base
    assert load(first).notes == ["later"]
    assert (first / "state" / "keys" / "a.bin").read_bytes() == b"a"
    assert (first / "state" / "b.bin").read_bytes() == b"b"


def test_a_map_replaces_a_map_and_keeps_what_is_not_ours(tmp_path: Path) -> None:
    folder = write(tmp_path / "m")
    (folder / "my-notes.txt").write_text("mine")
    write(folder, notes=("second",))
    assert load(folder).notes == ["second"]
    assert (folder / "my-notes.txt").read_text() == "mine"
    assert [p.name for p in tmp_path.iterdir()] == ["m"]


def test_what_is_not_a_map_is_left_alone(tmp_path: Path) -> None:
    photos = tmp_path / "photos"
    photos.mkdir()
    (photos / "cat.jpg").write_bytes(b"meow")
    with pytest.raises(MapError, match="not a map; left alone"):
        write(photos)
    assert files_of(photos) == {"cat.jpg": b"meow"}
    (photos / "scene.ttl").write_text("<urn:not> <urn:a> <urn:map> .")
    with pytest.raises(MapError, match="not a map; left alone"):
        check_out(photos)
    file = tmp_path / "file"
    file.write_text("x")
    with pytest.raises(MapError, match="is a file"):
        check_out(file)


def test_the_current_folder_is_not_swapped_away(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(MapError, match="current folder"):
        check_out(".")


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert load(write(tmp_path / "empty")).kinds["Room"] == 2


def test_out_that_cant_be_written_is_told_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(MapError, match="not writable"):
        check_out(tmp_path / "file" / "below" / "map")
    with pytest.raises(MapError, match="not writable"):
        check_out("/proc/afkb-map")


class Broken:
    name = "broken"
    in_map_folder = True

    def export(self, topological_map: object, folder: Path, run: object) -> list[Path]:
        raise OSError(28, "No space left on device")


def test_a_failed_write_leaves_the_old_map(tmp_path: Path) -> None:
    folder = write(tmp_path / "m")
    before = files_of(folder)
    with pytest.raises(MapError, match="No space left"):
        write_map(folder, sample_map(), {}, [Broken()], Names())
    assert files_of(folder) == before
    assert [p.name for p in tmp_path.iterdir()] == ["m"]


def test_killed_at_any_moment_the_folder_is_a_whole_map(tmp_path: Path) -> None:
    here, out = Path(__file__).parent, tmp_path / "m"
    write(out)
    code = (
        f"import sys; sys.path.insert(0, {str(here)!r})\n"
        "from test_store_roundtrip import write; from pathlib import Path\n"
        "print('ready', flush=True)\n"
        "n = 0\n"
        f"while True: n += 1; write(Path({str(out)!r}), notes=(f'visit {{n}}',))"
    )
    for delay in (0.02, 0.05, 0.11):
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as child:
            assert child.stdout is not None and child.stdout.readline() == b"ready\n"
            time.sleep(delay)
            child.send_signal(signal.SIGKILL)
        names = {"scene.ttl", "map.json", "occupancy.pgm", "report.html", "run.json"}
        assert names <= set(files_of(out))
        assert load(out).kinds["Room"] == 2


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (None, "not a map"),
        (b"<a:b> <c:d> 'x .\n", "not readable"),
        (b"", "no afn:Topological"),
        (b"\xff\xfe\x00", "not readable"),
    ],
)
def test_a_broken_map_is_told_in_one_line(tmp_path: Path, content: bytes | None, what: str) -> None:
    if content is not None:
        (tmp_path / "scene.ttl").write_bytes(content)
    with pytest.raises(MapError, match=what) as told:
        load(tmp_path)
    assert "\n" not in str(told.value)


def test_what_a_killed_run_left_is_cleared_away(tmp_path: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as gone:
        pass
    (tmp_path / f".m.{gone.pid}.x.partial").mkdir()
    (tmp_path / f".m.{os.getpid()}.y.partial").mkdir()
    write(tmp_path / "m")
    assert sorted(p.name for p in tmp_path.iterdir()) == [f".m.{os.getpid()}.y.partial", "m"]


@pytest.mark.parametrize("wrong", [{"yaw": math.nan}, {"existence": 1.2}, {"existence": math.nan}])
def test_numbers_that_mean_nothing_are_refused(tmp_path: Path, wrong: dict[str, float]) -> None:
    with pytest.raises(MapError, match="#n1: afn:"):
        write(tmp_path / "m", entities=(entity("n1", **wrong),), closures=(), edges=())
    assert not list(tmp_path.iterdir())


def test_a_map_of_a_later_format_is_refused(tmp_path: Path) -> None:
    folder = write(tmp_path / "m")
    scene = folder / "scene.ttl"
    scene.write_text(scene.read_text().replace("formatVersion 1", "formatVersion 2"))
    with pytest.raises(MapError, match="newer than this afkb"):
        load(folder)


def test_without_an_atomic_exchange_two_renames_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = write(tmp_path / "m")
    monkeypatch.setattr(folder_module, "_exchange", lambda a, b: False)
    write(folder, notes=("second",))
    assert load(folder).notes == ["second"]
    assert [p.name for p in tmp_path.iterdir()] == ["m"]


def test_no_such_map(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="no such map"):
        load(tmp_path / "nowhere")


def test_names_that_no_ontology_has_are_described_in_the_scene(tmp_path: Path) -> None:
    odd = entity("n1", affordances={"Hover ability/2": 0.8}, category_belief={"Drone": 0.5})
    folder = write(tmp_path / "m", entities=(odd,), closures=(), edges=())
    node = next(n for n in nodes_json(load(folder)) if n["id"] == "n1")
    assert node["affords"] == ["Hover ability/2"]
    assert node["category"] == {"Drone": 0.5}


def test_an_id_with_odd_characters_survives(tmp_path: Path) -> None:
    odd = entity("shelf 1/board<2>", seen_from=("p1",))
    folder = write(tmp_path / "m", entities=(odd,), closures=(), edges=())
    assert "shelf 1/board<2>" in [n["id"] for n in nodes_json(load(folder))]


def test_the_grid_keeps_probabilities_as_map_server_reads_them(folder: Path) -> None:
    settings = yaml.safe_load((folder / "occupancy.yaml").read_text())
    header, size, depth, pixels = (folder / settings["image"]).read_bytes().split(b"\n", 3)
    assert (header, size, depth, settings["mode"]) == (b"P5", b"60 30", b"255", "scale")
    p = (255 - np.frombuffer(pixels, np.uint8).reshape(30, 60)[::-1].astype(float)) / 255
    truth = sample_map().grid.probability
    known = np.isfinite(truth)
    assert np.abs(p[known] - truth[known]).max() < 0.006
    assert set(np.unique(p[~known])) == {(255 - 128) / 255}
    assert not np.any(np.isclose(p[known], (255 - 128) / 255))
    assert np.all(p[10:14, 20:26] > settings["occupied_thresh"])
    assert settings["origin"] == [-1.0, -0.5, 0.0]


def test_predicted_kinds_keep_their_class(tmp_path: Path) -> None:
    predicted = entity("n1", NodeKind.DUAL, predicted_from=("n2",), existence=0.7)
    folder = write(tmp_path / "m", entities=(predicted,), closures=(), edges=())
    node = next(n for n in nodes_json(load(folder)) if n["id"] == "n1")
    assert (node["kind"], node["existence"]) == ("DualPrediction", 0.7)
    assert math.isclose(node["yaw"], 0.1)


def test_loops_that_corrected_the_way_are_told_and_others_not(folder: Path) -> None:
    stored = load(folder)
    (loop,) = stored.instances("LoopCorrection")
    assert stored.number(loop, "afn:correction") == 0.48
    assert stored.name(loop, "afn:earlierPlace") == "p1"
