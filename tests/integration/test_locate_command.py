"""`afkb locate`: views of the bundled home in its own map, and what can be wrong with a map."""

import json
import math
import shutil

import numpy as np
import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost

WORLD = "world:paper_home"
pytestmark = pytest.mark.xdist_group("integration")


def locate(*arguments):
    return CliRunner().invoke(build_cli(PluginHost()), ["locate", *map(str, arguments)])


def test_views_are_found_where_the_map_says_they_were_taken(demo_folder) -> None:
    found = locate(demo_folder / "demo-map", WORLD, "--start", 40, "--stop", 46, "--json")
    assert found.exit_code == 0, found.output
    answers = json.loads(found.stdout)
    assert len(answers) == 6
    trajectory = np.loadtxt(demo_folder / "demo-map" / "state" / "trajectory.txt")
    known = [a for a in answers if not a["lost"]]
    assert len(known) >= 3
    for answer in known:
        row = trajectory[np.abs(trajectory[:, 0] - answer["stamp"]).argmin()]
        T = row[1:].reshape(4, 4)
        assert math.hypot(answer["x"] - T[0, 3], answer["y"] - T[1, 3]) < 0.25
        assert abs(math.remainder(answer["yaw"] - math.atan2(T[1, 0], T[0, 0]), math.tau)) < 0.17


def test_views_together_are_one_question_and_the_table_names_the_columns(demo_folder) -> None:
    found = locate(demo_folder / "demo-map", WORLD, "--stop", 6, "--views", 3)
    assert found.exit_code == 0, found.output
    lines = [x for x in found.stdout.splitlines() if x.strip()]
    assert "probability" in lines[0]
    assert len(lines) == 2 + 2


def test_bad_input_gets_one_line(demo_folder, tmp_path) -> None:
    without = tmp_path / "without"
    shutil.copytree(demo_folder / "demo-map", without)
    (without / "state" / "bands.npz").unlink()
    torn = tmp_path / "torn"
    shutil.copytree(demo_folder / "demo-map", torn)
    (torn / "state" / "bands.npz").write_bytes(b"PK")
    for folder, said in (
        (tmp_path / "nowhere", "nowhere"),
        (without, "bands.npz"),
        (torn, "bands.npz"),
    ):
        result = locate(folder, WORLD)
        lines = [x for x in result.stderr.splitlines() if x]
        assert result.exit_code == 1
        assert len(lines) == 1 and lines[0].startswith("error: ") and said in lines[0]


@pytest.mark.parametrize(("arguments", "said"), [(["no-such-recording"], "no-such-recording")])
def test_a_source_that_is_none_is_named(demo_folder, arguments, said) -> None:
    result = locate(demo_folder / "demo-map", *arguments)
    assert result.exit_code == 1 and said in result.stderr
