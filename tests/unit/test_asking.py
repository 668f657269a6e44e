"""Maps opened from Python answer as the commands do."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from afkb.asking import OpenMap, open_map, open_maps
from afkb.cli.app import build_cli
from afkb.errors import MapError, QueryError
from afkb.plugins.host import PluginHost
from afkb.store import write_map
from store_samples import Names, sample_map


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> OpenMap:
    folder = tmp_path_factory.mktemp("maps") / "home"
    return open_map(write_map(folder, sample_map(), {}, [], Names()))


def test_nodes_and_rooms_are_those_of_the_commands(home: OpenMap) -> None:
    cli = build_cli(PluginHost())
    told = json.loads(CliRunner().invoke(cli, ["rooms", str(home.folder), "--json"]).stdout)
    assert home.rooms() == told
    kinds = {node["kind"] for node in home.nodes()}
    assert {n["id"] for n in home.nodes("ObservedEntity")} < {n["id"] for n in home.nodes()}
    assert "RobotPlace" in kinds and home.doorways()
    with pytest.raises(ValueError, match="no kind of node is called 'Nonsense': "):
        home.nodes("Nonsense")


def test_rows_have_numbers_names_and_truth_as_python_has_them(home: OpenMap) -> None:
    (row,) = home.ask(
        "SELECT ?n ?z (COUNT(?b) AS ?beliefs) (?z > 0.5 AS ?high) ?nothing WHERE "
        "{ ?n a afn:ObservedEntity ; afn:z ?z ; afn:categoryBelief ?b FILTER(?n = scene:n1) } "
        "GROUP BY ?n ?z ?nothing"
    )
    assert row["n"] == "scene:n1" and isinstance(row["z"], float)
    assert type(row["beliefs"]) is int and row["high"] is True and row["nothing"] is None
    assert home.ask("ASK { ?n a afn:Room }") == [{"answer": True}]


def test_named_queries_take_parameters_and_refuse_names_that_nothing_has(home: OpenMap) -> None:
    assert home.ask("@room-beliefs")
    assert home.ask("@things-by-category category=Table")
    with pytest.raises(QueryError, match=r"category=Tabel: nothing is called that; .*Table"):
        home.ask("@things-by-category category=Tabel")


def test_finding_and_why_are_there(home: OpenMap) -> None:
    found = home.find("table")
    assert [r.probability for r in found] == sorted((r.probability for r in found), reverse=True)
    assert home.why("room1").id == "room1"


def test_a_fleet_is_asked_as_one_and_tells_its_maps_apart(home: OpenMap, tmp_path: Path) -> None:
    other = write_map(tmp_path / "my home", sample_map(), {}, [], Names())
    fleet = open_maps(home.folder, other)
    rows = fleet.ask("SELECT ?m (COUNT(?r) AS ?n) WHERE { GRAPH ?m { ?r a afn:Room } } GROUP BY ?m")
    assert {str(row["m"]) for row in rows} == set(fleet.graphs)
    assert fleet.graphs["urn:afkb:map:my%20home"].folder == other
    with pytest.raises(ValueError, match="folder of a map"):
        open_maps()


def test_what_is_no_map_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="not a map"):
        open_map(tmp_path)


def test_a_graph_is_named_by_its_map(home: OpenMap, tmp_path: Path) -> None:
    folder = write_map(tmp_path / "north flat: 3", sample_map(), {}, [], Names())
    asked = ["query", "--map", str(home.folder), "--map", str(folder), "--format", "csv"]
    count = "SELECT (COUNT(?r) AS ?n) WHERE { ?r a afn:Room }"
    cli = build_cli(PluginHost())
    told = CliRunner().invoke(cli, [*asked, "--graph", "north flat: 3", count])
    assert told.stdout.split() == ["n", "2"]


def test_a_query_that_finds_nothing_for_a_slip_says_so(home: OpenMap) -> None:
    asked = ["query", str(home.folder), "SELECT ?r WHERE { ?r a afn:Rom }"]
    told = CliRunner().invoke(build_cli(PluginHost()), asked)
    assert told.exit_code == 0
    assert "note: nothing is called afn:Rom; near it: afn:Room" in told.stderr
