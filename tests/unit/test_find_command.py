"""`afkb find` prints the contract's shape, and one line for what it can't find."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost
from afkb.store import write_map
from store_samples import Names, sample_map


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_map(tmp_path_factory.mktemp("maps") / "home", sample_map(), {}, [], Names())


@pytest.fixture(scope="module")
def host() -> PluginHost:
    return PluginHost()


def find(host: PluginHost, *arguments: str | Path) -> Result:
    return CliRunner().invoke(build_cli(host), ["find", *map(str, arguments)])


def test_regions_are_ranked_in_the_shape_of_the_contract(host, home) -> None:
    told = json.loads(find(host, home, "table", "--json").stdout)
    assert {"x", "y", "z", "probability", "seen", "reason"} <= set(told[0])
    assert told == sorted(told, key=lambda r: -r["probability"])
    assert told[0]["seen"] and "table" in told[0]["reason"]


def test_grasps_come_in_the_shape_that_the_reference_states(host, home) -> None:
    told = json.loads(find(host, home, "mug", "--grasp", "--json").stdout)
    assert all({"grasp", "approach", "width", "probability", "reason"} <= set(g) for g in told)


def test_what_is_no_thing_and_no_map_gets_one_line(host, home, tmp_path) -> None:
    told = find(host, home, "tabel")
    assert told.exit_code == 1 and "did you mean Table" in told.stderr
    assert find(host, tmp_path / "none", "mug").exit_code == 1
    assert len(told.stderr.splitlines()) == 1
