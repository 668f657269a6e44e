"""What becomes of a map when things go wrong: whether it is said, and the map stays consistent.

    python -m bench.mapping faults [--home HOME] [--other HOME] [--depth-only] [--things] [--json]
    python -m bench.mapping faults --mishap kidnapped --mishap "odometry jumps 2 m"

Beside the whole recording's map: distance of the views that were used from where they truly were,
rooms and pieces of wall (a doubled wall is one more), and what run.json says of it. With
`--things` all detectors run, and the nodes are counted too.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import Home, NoData, data_folder
from bench.mapping.altered import Alter, AlteringHost, without_laser
from bench.mapping.mishaps import (
    carried_back,
    followed_by,
    frames_lost,
    kidnapped,
    laser_blind,
    odometry_jumps,
)
from bench.trajectory import absolute_errors

FAST = ("laser-bounds",)
"""What poses, walls and rooms need."""
WRONG_M = 0.25
"""A used view further off than this spoils the map."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What homes: folders with `bag/` and `truth.json`."""
    homes = data_folder() / "homes"
    parser.add_argument("--home", type=Path, default=homes / "merom")
    parser.add_argument("--other", type=Path, default=homes / "pomaria", help="follows as if one")
    parser.add_argument("--things", action="store_true", help="run all detectors")
    parser.add_argument("--mishap", action="append", metavar="NAME", help="only these; default all")
    parser.add_argument("--depth-only", action="store_true", help="the laser is switched off")


def run(args: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """What came of each mishap; raises `NoData` where a home is missing."""
    for folder in (args.home, args.other):
        if not (folder / "truth.json").is_file():
            raise NoData(f"{folder}: no home with truth.json; name one, or set AFKB_DATA")
    other = list(PluginHost().open_source(str(args.other / "bag")).views())
    mishaps: dict[str, Alter] = {
        "nothing": lambda frames: frames,
        "odometry jumps 2 m": odometry_jumps(0.5),
        "kidnapped": kidnapped(0.6),
        "carried back to the start": carried_back(0.8),
        "laser blind for 100 scans": laser_blind(0.3),
        "30 % of frames lost": frames_lost,
        "two homes as one": followed_by(other),
    }
    if unknown := set(args.mishap or ()) - set(mishaps):
        raise NoData(f"no mishap {', '.join(sorted(unknown))}; there are: {', '.join(mishaps)}")
    return {name: _with(mishaps[name], args) for name in args.mishap or mishaps}


def _with(mishap: Alter, args: argparse.Namespace) -> dict[str, Any]:
    alter: Alter = (lambda f: without_laser(mishap(f))) if args.depth_only else mishap
    host = AlteringHost(alter)
    home = Home(args.home, host)
    detectors = () if args.things else FAST
    with tempfile.TemporaryDirectory() as scratch:
        uri = str(args.home / "bag")
        found = make_map(host, Settings(uri=uri, out=Path(scratch) / "map", detectors=detectors))
    made, frames = found.topological_map, found.run["frames"]
    assert isinstance(frames, dict)
    trajectory = np.array(made.trajectory)
    poses = trajectory[:, 1:17].reshape(-1, 4, 4)
    stamps = _first_stamps(trajectory[:, 0], args, alter)
    off = absolute_errors(stamps, np.linalg.inv(poses[0]) @ poses, home.truth)[:, 0]
    return {
        "used": frames["used"],
        "skipped": frames["skipped"],
        "mean_m": float(off.mean()),
        "greatest_m": float(off.max()),
        "wrong": int((off > WRONG_M).sum()),
        "rooms": len(made.rooms),
        "bounds": len(made.bounds),
        "nodes": len(made.places) + len(made.entities),
        "notes": list(made.notes),
    }


def _first_stamps(stamps: np.ndarray, args: argparse.Namespace, alter: Alter) -> np.ndarray:
    """The true stamp of each used view: a tour made again has later ones."""
    source = PluginHost().open_source(str(args.home / "bag"))
    own = list(source.views())
    true = {id(f.depth_m): f.stamp for f in own if isinstance(f, View)}
    told = {
        round(f.stamp, 6): true.get(id(f.depth_m), np.nan)
        for f in alter(own)
        if isinstance(f, View)
    }
    return np.array([told.get(round(float(t), 6), np.nan) for t in stamps])


def table(result: dict[str, dict[str, Any]]) -> Iterator[str]:
    """A line a mishap, and what the run said of it."""
    yield f"{'':28} used skipped  mean, m greatest, m wrong rooms walls nodes"
    for name, r in result.items():
        yield (
            f"{name:28} {r['used']:4} {r['skipped']:7} {r['mean_m']:8.3f} {r['greatest_m']:11.3f}"
            f" {r['wrong']:5} {r['rooms']:5} {r['bounds']:5} {r['nodes']:5}"
        )
        for note in r["notes"]:
            yield f"{'':28} {note}"
