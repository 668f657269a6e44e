"""Self-localisation of views in the map of another visit, with no idea of where they were taken."""

from __future__ import annotations

import argparse
import json
import math
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import T_from_xy_yaw, yaw_of
from afkb_mapping.localisation.localiser import Localiser
from afkb_mapping.localisation.questions import asked, localiser_of
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import NoData, data_folder
from bench.detectors.seen import placed_views

RIGHT_M, RIGHT_RAD = 0.25, math.radians(10)
NONSENSE = 0.6
"""Share of the beams that are replaced by random ranges."""
SEED = 1

Array = NDArray[np.float64]
Sense = Callable[[View, np.random.Generator], View]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What is asked where: homes are folders with `bag/` and `truth.json`."""
    homes = data_folder() / "homes"
    parser.add_argument("--map", type=Path, help="map of --mapped that stands already")
    parser.add_argument("--mapped", type=Path, default=homes / "merom")
    parser.add_argument("--asked", type=Path, default=homes / "merom-later")
    parser.add_argument("--stride", type=int, default=1, help="ask for every N-th view")


def run(args: argparse.Namespace) -> dict[str, dict[str, float]]:
    """Shares of answers that are right, wrong and lost, by what was sensed."""
    folder, mapped, asked_home, stride = args.map, args.mapped, args.asked, args.stride
    for home in (mapped, asked_home):
        if not (home / "truth.json").is_file():
            raise NoData(f"{home}: no home with truth.json; name one, or set AFKB_DATA")
    host = PluginHost()
    with tempfile.TemporaryDirectory() as scratch:
        localiser = localiser_of(folder or _mapped(host, mapped, Path(scratch) / "map"))
    truth = json.loads((asked_home / "truth.json").read_text())
    first = json.loads((mapped / "truth.json").read_text())["views"][0]
    T_map_world = np.linalg.inv(T_from_xy_yaw(first["x"], first["y"], first["yaw"]))
    source = host.open_source(str(asked_home / "bag"))
    views = [
        replace(v, T_map_base=T_map_world @ v.T_map_base)
        for v in placed_views(source.views(), truth)
    ]
    return {
        name: _asked_with(localiser, views, sense, together, stride)
        for name, (sense, together) in SENSES.items()
    }


def _mapped(host: PluginHost, home: Path, out: Path) -> Path:
    """A map for locating alone: what things are is not asked."""
    make_map(host, Settings(uri=str(home / "bag"), out=out, detectors=("laser-bounds",)))
    return out


def _asked_with(
    localiser: Localiser, views: Sequence[View], sense: Sense, together: int, stride: int
) -> dict[str, float]:
    rng = np.random.default_rng(SEED)
    right = wrong = 0
    errors, seconds = [], []
    ends = range(together - 1, len(views), stride)
    for end in ends:
        question = [sense(v, rng) for v in views[end - together + 1 : end + 1]]
        start = time.thread_time()
        found = localiser.locate(asked(question, np.eye(4)))
        seconds.append(time.thread_time() - start)
        if found.lost:
            continue
        T = views[end].T_map_base
        assert T is not None
        off = math.hypot(found.x - T[0, 3], found.y - T[1, 3])
        turned = abs(math.remainder(found.yaw - yaw_of(T), math.tau))
        is_right = off <= RIGHT_M and turned <= RIGHT_RAD
        right, wrong = right + is_right, wrong + (not is_right)
        errors += [off] if is_right else []
    n = len(ends)
    return {
        "asked": n,
        "right": right / n,
        "wrong": wrong / n,
        "lost": 1 - (right + wrong) / n,
        "error_m": float(np.median(errors)) if errors else math.nan,
        "seconds": float(np.median(seconds)),
    }


def _laser(view: View, _: np.random.Generator) -> View:
    return replace(view, depth_m=None, camera=None)


def _nonsense(view: View, rng: np.random.Generator) -> View:
    assert view.scan is not None
    ranges = view.scan.ranges_m.copy()
    wrong = rng.random(len(ranges)) < NONSENSE
    ranges[wrong] = rng.uniform(0.3, 6.0, int(wrong.sum()))
    return replace(_laser(view, rng), scan=replace(view.scan, ranges_m=ranges))


def _depth(view: View, _: np.random.Generator) -> View:
    return replace(view, scan=None)


def _all(view: View, _: np.random.Generator) -> View:
    return view


SENSES: dict[str, tuple[Sense, int]] = {
    "laser and depth": (_all, 1),
    "laser": (_laser, 1),
    "laser, 60 % of the beams nonsense": (_nonsense, 1),
    "depth": (_depth, 1),
    "depth, three views": (_depth, 3),
}


def table(result: dict[str, dict[str, Any]]) -> Iterator[str]:
    yield f"{'right is within 0.25 m and 10°':36} right wrong  lost  error, m  CPU s"
    for name, r in result.items():
        yield (
            f"{name:36} {r['right']:5.3f} {r['wrong']:5.3f} {r['lost']:5.3f}"
            f"  {r['error_m']:8.3f} {r['seconds']:6.2f}   of {r['asked']}"
        )
