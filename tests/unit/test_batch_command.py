"""`afkb batch` as a user runs it: Dask's workers, a failure among others, a server for the maps."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np

from afkb.fleet import Server, kept_maps
from afkb.knowledge import AfNet
from afkb.store import load, write_map
from afkb.store.made_with import ontology_record
from afkb_mapping.run_record import Settings
from laser_samples import FLAT, ranges
from oxigraph_server import oxigraph_server
from store_samples import Names, sample_map

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


def map_of(source: Path, folder: Path) -> int:
    """A map as an earlier batch left it; when it was written."""
    settings = Settings(uri=str(source), out=folder)
    parameters = {f.name: getattr(settings, f.name) for f in fields(settings)}
    told = {name: parameters[name] for name in parameters if name not in ("uri", "out", "view")}
    run = {"source": str(source), "parameters": told, "ontology": ontology_record(AfNet().files)}
    return (write_map(folder, sample_map(), run, [], Names()) / "run.json").stat().st_mtime_ns


def test_one_failure_stops_no_other_and_what_is_done_is_kept_and_not_done_again(tmp_path):
    log, out = tmp_path / "drive.log", tmp_path / "maps"
    write_drive(log)
    written = map_of(tmp_path / "data", out / "done")
    map_of(tmp_path / "elsewhere", out / "taken")
    with oxigraph_server(tmp_path / "data") as process:
        sources = (f"taken={tmp_path}", log, f"done={tmp_path / 'data'}")
        store = ("--store", process.url, "--prefix", "north")
        code, found, said = batch(*sources, "--out", out, "--resume", "--workers", 1, *store)
        kept = [k.name for k in kept_maps(Server.find(process.url))]
    assert code == 1 and "3/3" in said
    assert f"is a map of {tmp_path / 'elsewhere'}" in found["taken"]["error"]
    assert (found["drive"]["state"], found["drive"]["frames"]) == ("mapped", 4)
    assert load(out / "drive").kinds["RobotPlace"] > 0
    assert found["done"]["state"] == "skipped"
    assert (out / "done" / "run.json").stat().st_mtime_ns == written
    assert kept == ["north/done", "north/drive"]
    assert found["drive"]["stored"] == "urn:afkb:map:north/drive"
