"""`afkb route`: ways in the bundled home's map, a search in it, and ends that are none."""

import json
import math

import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost

pytestmark = pytest.mark.xdist_group("integration")


def route(*arguments):
    return CliRunner().invoke(build_cli(PluginHost()), ["route", *map(str, arguments)])


def test_a_way_from_room_to_room_has_its_length_its_corners_and_its_nodes(demo_folder) -> None:
    found = route(demo_folder / "demo-map", "--from", "Bedroom", "--to", "LivingRoom", "--json")
    assert found.exit_code == 0, found.output
    way = json.loads(found.stdout)
    legs = zip(way["path"], way["path"][1:], strict=False)
    assert math.isclose(way["length"], sum(math.dist(a, b) for a, b in legs), abs_tol=0.02)
    assert len(way["nodes"]) >= 3 and len(way["doorways"]) >= 1
    assert way["rooms"][0] != way["rooms"][-1]


def test_a_search_looks_in_the_kitchen_and_beats_naive_orders(demo_folder) -> None:
    found = route(demo_folder / "demo-map", "--from", "Bedroom", "--to", "jar", "--json")
    assert found.exit_code == 0, found.output
    told = json.loads(found.stdout)
    assert told["if_known"] <= told["expected_length"]
    assert told["expected_length"] <= min(told["nearest_first"], told["most_probable_first"])
    assert 0 < told["nowhere"] < 1 and len(told["places"]) >= 2


def test_ends_that_are_none_get_one_line(demo_folder) -> None:
    found = route(demo_folder / "demo-map", "--from", "Kitchn", "--to", "mug")
    lines = [x for x in found.stderr.splitlines() if x]
    assert found.exit_code == 1 and len(lines) == 1 and "did you mean Kitchen" in lines[0]
