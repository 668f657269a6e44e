from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner, Result

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost
from figures_samples import HM3D, MATTERPORT, tables, write


def count(folder: Path, *arguments: str) -> Result:
    command = ["ontology", "count", *arguments, "--tables", str(tables(folder / "tables"))]
    return CliRunner().invoke(build_cli(PluginHost()), command)


def test_counting_again_gives_the_same_bytes(tmp_path: Path) -> None:
    rooms = [write(tmp_path / "a.csv", HM3D), write(tmp_path / "b.csv", MATTERPORT)]
    for out, order in (("once", rooms), ("twice", rooms[::-1])):
        done = count(tmp_path, *map(str, order), "--out", str(tmp_path / out))
        assert done.exit_code == 0, done.output
    for path in (tmp_path / "once").iterdir():
        assert path.read_bytes() == (tmp_path / "twice" / path.name).read_bytes()


def test_what_was_not_understood_is_told(tmp_path: Path) -> None:
    rooms = write(tmp_path / "a.csv", HM3D)
    told = count(tmp_path, str(rooms), "--out", str(tmp_path / "out"))
    assert "1 names of things not understood; the commonest: yoke (3)" in told.stderr
    found = json.loads(count(tmp_path, str(rooms), "--json", "--out", str(tmp_path / "out")).stdout)
    assert found["sources"][0]["rooms left out"] == 3
    assert found["unknown_names"]["things"] == {"hm3d": {"yoke": 3}}


def test_a_bad_table_leaves_nothing_half_written(tmp_path: Path) -> None:
    rooms = write(tmp_path / "a.csv", HM3D + "C,9,Bedroom,bed:x\n")
    done = count(tmp_path, str(rooms), "--out", str(tmp_path / "out"))
    assert done.exit_code == 1
    assert done.stderr.startswith(f"error: {rooms}, line 9: the count of 'bed' is 'x'")
    assert not (tmp_path / "out").exists()
