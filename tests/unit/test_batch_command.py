"""`afkb batch` as a user runs it: Dask's workers, a failure among others, a server for the maps."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from afkb.fleet import Server, kept_maps
from afkb.store import load
from laser_samples import FLAT, ranges
from oxigraph_server import oxigraph_server

BEAMS = 181


def write_drive(path: Path, scans: int = 4) -> None:
    """A CARMEN log of a short drive through a flat."""
    lines = []
    for k in range(scans):
        x, y = 2.0 + 0.3 * k, 2.0
        found = ranges(FLAT, x, y, np.linspace(-np.pi / 2, np.pi / 2, BEAMS), 12.0)
        pose = f"{x} {y} 0.0"
        beams = " ".join(f"{r:.3f}" for r in np.minimum(found, 12.0))
        lines.append(f"FLASER {BEAMS} {beams} {pose} {pose} {k}.0 robot {k}.0")
    path.write_text("\n".join(lines) + "\n")


def batch(*arguments: object) -> tuple[int, dict[str, dict[str, object]], str]:
    """Exit code, outcomes by name, and what was said besides."""
    command = [sys.executable, "-m", "afkb.cli.app", "batch", "--json", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    told = json.loads(done.stdout)
    assert told["failed"] == sum(found["error"] is not None for found in told["maps"])
    return done.returncode, {found["name"]: found for found in told["maps"]}, done.stderr


def test_one_failure_stops_no_other_and_what_is_done_is_kept_and_not_done_again(tmp_path):
    log, out = tmp_path / "drive.log", tmp_path / "maps"
    write_drive(log)
    with oxigraph_server(tmp_path / "data") as process:
        common = (log, "--out", out, "--store", process.url, "--prefix", "north")
        code, first, said = batch("gone=/nowhere", *common, "--workers", 2)
        assert code == 1 and "2/2" in said
        assert first["gone"]["error"] == "/nowhere: no such file or folder"
        assert not (out / "gone").exists()
        assert first["drive"]["state"] == "mapped" and first["drive"]["frames"] == 4
        written = (out / "drive" / "run.json").stat().st_mtime_ns
        code, again, _ = batch(*common, "--resume")
        assert code == 0 and again["drive"]["state"] == "skipped"
        assert (out / "drive" / "run.json").stat().st_mtime_ns == written
        assert again["drive"]["stored"] == first["drive"]["stored"] == "urn:afkb:map:north/drive"
        assert [k.name for k in kept_maps(Server.find(process.url))] == ["north/drive"]
    assert load(out / "drive").kinds["RobotPlace"] > 0
