import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost


@pytest.fixture(scope="module")
def cli() -> object:
    return build_cli(PluginHost())


def asked(cli: object, *words: str) -> object:
    return CliRunner().invoke(cli, ["ontology", "network", *words])  # type: ignore[arg-type]


def test_every_statement_is_behind_a_node(cli: object) -> None:
    answer = asked(cli, "--json")
    assert answer.exit_code == 0, answer.output
    nodes = {node["name"]: node for node in json.loads(answer.stdout)}
    kb = PluginHost().knowledge_base
    behind = {name for node in nodes.values() for name in node["statements"]}
    assert {f.name for f in kb.objects_in_rooms} <= behind
    assert {d.name for d in kb.duals} | {c.name for c in kb.co_occurrences if c.is_rule} <= behind
    told = {frozenset(n.split(".")[:2]) for n in behind if n.endswith(".Together")}
    stated = {frozenset((f.category, f.given)) for f in kb.objects_with_objects}
    assert told <= stated
    assert len(told) > 0.8 * len(stated)  # The rooms explain the others.
    assert {"RoomCategory", "ShareSeen"} <= set(nodes["SinkInRoom"]["parents"])


def test_a_table_shows_kinds_and_one_term_its_nodes(cli: object) -> None:
    assert "whether a room holds one" in asked(cli).stdout
    of = asked(cli, "--of", "Kettle").stdout
    assert "KettleInRoom" in of
    assert "BedInRoom" not in of


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--of", "Unicorn"], "no node of the network has 'Unicorn'"),
        (["--out", "{tmp}/no/such/folder.bif"], "can't be written"),
    ],
)
def test_bad_wishes_get_one_line(cli: object, words: list[str], said: str, tmp_path: Path) -> None:
    answer = asked(cli, *(word.format(tmp=tmp_path) for word in words))
    assert answer.exit_code == 1
    assert said in str(answer.exception or "") + answer.output
