"""Every wrong input gets one clear line and exit 1, and leaves nothing half-written."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost

INTRINSICS = "100 0 80\n0 100 60\n0 0 1\n"
T_LOOKING_AHEAD = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1.2], [0, 0, 0, 1.0]])


@pytest.fixture(scope="module")
def afkb():
    cli, runner = build_cli(PluginHost()), CliRunner()
    return lambda *arguments: runner.invoke(cli, [str(a) for a in arguments])


def floor_and_wall():
    v = np.arange(120)[:, None] * np.ones((1, 160))
    with np.errstate(divide="ignore"):
        floor = 1.2 / ((v - 60) / 100)
    return np.where((floor > 0) & (floor < 3), floor, 3.0)


@pytest.fixture
def recording(tmp_path):
    """A folder of four good frames that this project's code has not written."""
    folder = tmp_path / "recording"
    folder.mkdir()
    (folder / "camera-intrinsics.txt").write_text(INTRINSICS)
    for i in range(4):
        depth = (1000 * floor_and_wall()).astype(np.uint16)
        cv2.imwrite(str(folder / f"frame-{i:06d}.depth.png"), depth)
        np.savetxt(folder / f"frame-{i:06d}.pose.txt", T_LOOKING_AHEAD)
    return folder


def refused(result, *words):
    """One line on stderr, exit 1, no traceback; it contains the words."""
    assert result.exit_code == 1, (result.exit_code, result.output)
    lines = [line for line in result.stderr.splitlines() if line.startswith("error: ")]
    assert len(lines) == 1
    assert "Traceback" not in result.output
    for word in words:
        assert str(word) in lines[0]


def test_a_good_recording_is_mapped(afkb, recording, tmp_path):
    result = afkb("map", recording, "--out", tmp_path / "map")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "map" / "scene.ttl").is_file()


def test_missing_folder(afkb, tmp_path):
    refused(afkb("map", tmp_path / "nowhere", "--out", tmp_path / "map"), "nowhere", "no such")
    assert not (tmp_path / "map").exists()


def test_empty_folder(afkb, tmp_path):
    (tmp_path / "empty").mkdir()
    refused(afkb("map", tmp_path / "empty", "--out", tmp_path / "map"), "empty")


def test_missing_intrinsics(afkb, recording, tmp_path):
    (recording / "camera-intrinsics.txt").unlink()
    refused(afkb("map", recording, "--out", tmp_path / "map"), "intrinsics")


@pytest.mark.parametrize("text", ["0 0 0\n0 0 0\n0 0 1\n", "nan 0 1\n0 nan 1\n0 0 1\n", "hello"])
def test_useless_intrinsics(afkb, recording, tmp_path, text):
    (recording / "camera-intrinsics.txt").write_text(text)
    refused(afkb("map", recording, "--out", tmp_path / "map"), "intrinsics")


def truncate(path):
    path.write_bytes(path.read_bytes()[:200])


def eight_bit(path):
    cv2.imwrite(str(path), np.full((120, 160), 90, np.uint8))


def all_zero(path):
    cv2.imwrite(str(path), np.zeros((120, 160), np.uint16))


@pytest.mark.parametrize("spoil", [truncate, eight_bit, all_zero])
def test_a_bad_depth_image_is_skipped_and_counted(afkb, recording, tmp_path, spoil):
    spoil(recording / "frame-000002.depth.png")
    result = afkb("map", recording, "--out", tmp_path / "map")
    assert result.exit_code == 0, result.output
    assert "frame-000002" in result.stderr
    assert '"skipped": 1' in (tmp_path / "map" / "run.json").read_text()


@pytest.mark.parametrize("spoil", [truncate, eight_bit, all_zero])
def test_only_bad_depth_images_are_an_error(afkb, recording, tmp_path, spoil):
    for path in recording.glob("*.depth.png"):
        spoil(path)
    refused(afkb("map", recording, "--out", tmp_path / "map"), "frame-000000")
    assert not (tmp_path / "map").exists()


@pytest.mark.parametrize("pose", ["nan " * 16, "1 2 3", None])
def test_a_bad_or_missing_pose_is_skipped_and_counted(afkb, recording, tmp_path, pose):
    path = recording / "frame-000001.pose.txt"
    path.unlink() if pose is None else path.write_text(pose)
    result = afkb("map", recording, "--out", tmp_path / "map")
    assert result.exit_code == 0, result.output
    assert "frame-000001" in result.stderr


def test_an_absurd_pose_is_skipped_and_the_map_stays_small(afkb, recording, tmp_path):
    T = T_LOOKING_AHEAD.copy()
    T[0, 3] = 1e6
    np.savetxt(recording / "frame-000002.pose.txt", T)
    result = afkb("map", recording, "--out", tmp_path / "map")
    assert result.exit_code == 0, result.output
    assert "1e+06 m from the last one" in result.stderr
    assert (tmp_path / "map" / "occupancy.pgm").stat().st_size < 1_000_000


def test_a_recording_may_be_named_by_a_file_uri(afkb, recording, tmp_path):
    result = afkb("map", recording.as_uri(), "--out", tmp_path / "map")
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize("name", ["noise.bag", "noise.mcap", "noise.log", "noise.db3"])
def test_random_bytes_under_a_recordings_name(afkb, tmp_path, name):
    (tmp_path / name).write_bytes(np.random.default_rng(1).bytes(4096))
    refused(afkb("map", tmp_path / name, "--out", tmp_path / "map"), name)


def test_a_carmen_line_cut_short_is_skipped(afkb, tmp_path):
    beams = " ".join(["3.0"] * 180)
    good = f"FLASER 180 {beams} 0.1 0 0 0.1 0 0 1.0 robot 1.0\n"
    (tmp_path / "run.log").write_text(good + good[:300] + "\n" + good.replace("1.0 robot", "2.0 r"))
    result = afkb("map", tmp_path / "run.log", "--out", tmp_path / "map")
    assert result.exit_code == 0, result.output
    assert '"skipped": 1' in (tmp_path / "map" / "run.json").read_text()


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_an_unwritable_out_folder(afkb, recording, tmp_path):
    (tmp_path / "locked").mkdir(mode=0o500)
    refused(afkb("map", recording, "--out", tmp_path / "locked" / "map"), "not writable")


def test_out_below_a_file(afkb, recording, tmp_path):
    (tmp_path / "file").write_text("mine")
    refused(afkb("map", recording, "--out", tmp_path / "file" / "map"), "file")


def test_out_that_holds_something_else_is_left_alone(afkb, recording, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter1.tex").write_text("years of work")
    refused(afkb("map", recording, "--out", tmp_path / "thesis"), "not a map", "left alone")
    assert [p.name for p in (tmp_path / "thesis").iterdir()] == ["chapter1.tex"]


@pytest.mark.parametrize(
    ("option", "word"),
    [("--detector", "surfaces"), ("--mapper", "affordance"), ("--rule", "log-odds")],
)
def test_an_unknown_plugin_name_lists_the_known_ones(afkb, recording, tmp_path, option, word):
    out = tmp_path / "map"
    refused(afkb("map", recording, "--out", out, option, "wizard"), "wizard", word)
    assert not out.exists()


def test_no_such_map(afkb, tmp_path):
    for command in ("info", "rooms"):
        refused(afkb(command, tmp_path / "nowhere"), "nowhere")
    refused(afkb("query", tmp_path / "nowhere", "ASK {}"), "nowhere")


def test_a_query_that_is_not_sparql_or_not_allowed(afkb, recording, tmp_path):
    out = tmp_path / "map"
    assert afkb("map", recording, "--out", out).exit_code == 0
    refused(afkb("query", out, "SELECT ?x WHERE { ?x a afn:Room"), "line 1")
    before = (out / "scene.ttl").read_bytes()
    refused(afkb("query", out, "DELETE WHERE { ?s ?p ?o }"), "update")
    assert (out / "scene.ttl").read_bytes() == before


def test_a_command_line_that_is_wrong_exits_with_2(afkb):
    assert afkb("map").exit_code == 2
    assert afkb("fly").exit_code == 2


def test_a_real_process_prints_no_traceback(tmp_path):
    executable = Path(sys.executable).parent / "afkb"
    if not executable.exists():
        executable = shutil.which("afkb")
    done = subprocess.run(
        [executable, "map", tmp_path / "nowhere", "--out", tmp_path / "map"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr.startswith("error: ")
    assert len(done.stderr.splitlines()) == 1
