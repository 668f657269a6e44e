"""A map's rooms become a table to correct; the table becomes an extension that refits figures."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from afkb.cli.app import build_cli
from afkb.errors import KnowledgeError, MapError
from afkb.knowledge import AfNet
from afkb.learning import learnt, rooms_of, table_text
from afkb.plugins.host import PluginHost
from afkb.store import load, write_map
from store_samples import sample_map

KITCHENS = "building,room,category,objects\n" + "".join(
    f"flat-{i},r1,kitchen,teapot:1\nflat-{i},r2,bedroom,bed:1\n" for i in range(40)
)


def run(*arguments: str) -> Result:
    return CliRunner().invoke(build_cli(PluginHost()), ["ontology", *arguments])


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("maps") / "my-flat"
    write_map(folder, sample_map(), {}, exporters=[], knowledge_base=AfNet())
    return folder


@pytest.fixture
def kitchens(tmp_path: Path) -> Path:
    (tmp_path / "homes.csv").write_text(KITCHENS)
    return tmp_path / "homes.csv"


def test_a_row_a_room_that_the_robot_stood_in(home: Path) -> None:
    rows = list(csv.DictReader(table_text(rooms_of(load(home)), AfNet()).splitlines()))
    assert [(row["building"], row["room"], row["category"]) for row in rows] == [
        ("my-flat", "room1", "kitchen")
    ]
    assert "mug:1" in rows[0]["objects"].split("|")


def test_two_maps_of_one_name_are_refused(home: Path) -> None:
    with pytest.raises(MapError, match="two maps are called 'my-flat'"):
        table_text([*rooms_of(load(home)), *rooms_of(load(home))], AfNet())


def test_what_own_rooms_hold_is_likelier_and_what_they_lack_is_less(kitchens: Path) -> None:
    lessons = learnt([kitchens])
    assert (lessons.homes, lessons.rooms, lessons.things) == (40, 80, 80)
    figures = {(c.category, c.room): c for c in lessons.changed}
    teapot, none = figures["Teapot", "Kitchen"], figures["Bed", "Kitchen"]
    assert teapot.before is not None and teapot.after > teapot.before + 0.1
    assert none.before is not None and none.after < none.before
    assert lessons.changed[0] == teapot


def test_the_extension_changes_the_networks_figures(kitchens: Path) -> None:
    out = kitchens.with_name("learnt.yaml")
    done = run("learn", str(kitchens), "--out", str(out), "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)["changed"][0]
    kb = AfNet(extensions=[out])
    figure = next(
        f for f in kb.objects_in_rooms if (f.category, f.room) == (told["category"], told["room"])
    )
    assert figure.probability == pytest.approx(told["after"], rel=1e-3)


def test_from_map_to_table_to_extension(home: Path, tmp_path: Path) -> None:
    table, out = tmp_path / "mine.csv", tmp_path / "mine.yaml"
    assert run("homes", str(home), "--out", str(table)).exit_code == 0
    done = run("learn", str(table), "--out", str(out))
    assert done.exit_code == 0, done.output
    assert "learnt from 1 homes, 1 rooms" in done.stderr
    again = run("homes", str(home), "--out", str(table))
    assert again.exit_code == 1
    assert "perhaps corrected" in again.stderr


@pytest.mark.parametrize(
    ("rows", "wrong"),
    [
        ("f,r,kitchen,mug:x\n", "line 2: the count of 'mug' is 'x'"),
        ("f,r,kitchen,mug\n", "line 2: objects has 'mug'"),
        ("f,r,lair,mug:1\n", "no room of a known category"),
        ("f,r,kitchen,mug:1\nf,r,kitchen,mug:1\n", "line 3: room 'r' of 'f' stands in"),
    ],
)
def test_a_bad_table_is_told_and_nothing_is_written(tmp_path: Path, rows: str, wrong: str) -> None:
    table, out = tmp_path / "bad.csv", tmp_path / "bad.yaml"
    table.write_text("building,room,category,objects\n" + rows)
    with pytest.raises(KnowledgeError, match=wrong):
        learnt([table])
    assert run("learn", str(table), "--out", str(out)).exit_code == 1
    assert not out.exists()


def test_names_that_nothing_has_are_told(tmp_path: Path) -> None:
    table = tmp_path / "odd.csv"
    table.write_text("building,room,category,objects\nf,r,kitchen,frobnicator:2|mug:1\n")
    done = run("learn", str(table), "--out", str(tmp_path / "odd.yaml"))
    assert "1 names of things not understood, and left out: frobnicator (2)" in done.stderr


def test_an_extension_that_is_there_is_kept(kitchens: Path) -> None:
    out = kitchens.with_name("mine.yaml")
    out.write_text("extension: mine\n")
    done = run("learn", str(kitchens), "--out", str(out))
    assert done.exit_code == 1 and "is there already" in done.stderr
    assert out.read_text() == "extension: mine\n"
