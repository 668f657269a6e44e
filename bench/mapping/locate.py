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
from afkb_mapping.localisation.bands import STATE_FILE, HeightBands
from afkb_mapping.localisation.localiser import Localiser
from afkb_mapping.localisation.questions import asked
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import NoData, data_folder
from bench.detectors.seen import placed_views
from bench.mapping.locate_changes import without
from bench.mapping.locate_peers import Peer, feature_matching, scan_matching

RIGHT_M, RIGHT_RAD = 0.25, math.radians(10)
NONSENSE = 0.6
"""Share of the beams that are replaced by random ranges."""
SEED = 1
GONE = (0.25, 0.5, 0.75)
"""Shares of the low things that are taken out of the map."""
NEAR_M = (0.25, 0.5, 1.0, math.inf)
"""Distances to the nearest mapped view, by which answers are grouped."""

Array = NDArray[np.float64]
Sense = Callable[[View, np.random.Generator], View]
Answer = tuple[bool, float, float, float]
Ask = Callable[[Sequence[View]], Answer]
"""Whether lost, x, y (m) and yaw (rad), from some views."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What is asked where: homes are folders with `bag/` and `truth.json`."""
    homes = data_folder() / "homes"
    parser.add_argument("--map", type=Path, help="map of --mapped that stands already")
    parser.add_argument("--mapped", type=Path, default=homes / "merom")
    parser.add_argument("--asked", type=Path, default=homes / "merom-later")
    parser.add_argument("--elsewhere", type=Path, default=homes / "pomaria", help="another home")
    parser.add_argument("--stride", type=int, default=1, help="ask for every N-th view")
    parser.add_argument("--peer-stride", type=int, default=8, help="ask peers for every N-th view")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Shares of answers that are right, wrong and lost.

    By what was sensed, beside peers, by what has changed, by how far off the nearest mapped view
    is, and for another home.
    """
    for home in (args.mapped, args.asked, args.elsewhere):
        if not (home / "truth.json").is_file():
            raise NoData(f"{home}: no home with truth.json; name one, or set AFKB_DATA")
    host = PluginHost()
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.map or _mapped(host, args.mapped, Path(scratch) / "map")
        bands = HeightBands.from_bytes((folder / "state" / STATE_FILE).read_bytes())
    views, mapped_xy = _views(host, args.asked, args.mapped), _places(args.mapped)
    elsewhere = _views(host, args.elsewhere, args.mapped)
    ask, stride, more = _asking(Localiser(bands)), args.stride, args.peer_stride
    return {
        "senses": {
            name: _shares(_answers(ask, views, sense, together, stride))
            for name, (sense, together) in SENSES.items()
        },
        "peers": {
            name: _shares(_answers(_asking_peer(peer), views, sense, 1, more))
            for name, (peer, sense) in _peers(bands).items()
        },
        "gone": {
            f"{share:.0%}": _shares(
                _answers(_asking(_changed(bands, share)), views, _depth, 1, more)
            )
            for share in GONE
        },
        "near": _by_distance(_answers(ask, views, _depth, 1, stride), mapped_xy),
        "elsewhere": {
            name: _shares(_answers(ask, elsewhere, sense, together, more))
            for name, (sense, together) in SENSES.items()
        },
    }


def _mapped(host: PluginHost, home: Path, out: Path) -> Path:
    """A map for locating alone: what things are is not asked."""
    make_map(host, Settings(uri=str(home / "bag"), out=out, detectors=("laser-bounds",)))
    return out


def _T_map_world(mapped: Path) -> Array:
    first = json.loads((mapped / "truth.json").read_text())["views"][0]
    T: Array = np.asarray(np.linalg.inv(T_from_xy_yaw(first["x"], first["y"], first["yaw"])))
    return T


def _places(mapped: Path) -> Array:
    """(N, 2) m, map frame: where its views were taken."""
    seen = json.loads((mapped / "truth.json").read_text())["views"]
    xy: Array = np.array([[v["x"], v["y"], 0.0, 1.0] for v in seen]) @ _T_map_world(mapped).T
    return xy[:, :2]


def _views(host: PluginHost, home: Path, mapped: Path) -> list[View]:
    """Views of a home, placed where they were taken, in the frame of the map."""
    truth = json.loads((home / "truth.json").read_text())
    T = _T_map_world(mapped)
    placed = placed_views(host.open_source(str(home / "bag")).views(), truth)
    return [replace(v, T_map_base=T @ v.T_map_base) for v in placed if v.T_map_base is not None]


def _changed(bands: HeightBands, share: float) -> Localiser:
    return Localiser(without(bands, share, np.random.default_rng(SEED)))


def _asking(localiser: Localiser) -> Ask:
    def ask(views: Sequence[View]) -> Answer:
        found = localiser.locate(asked(views, np.eye(4)))
        return found.lost, found.x, found.y, found.yaw

    return ask


def _asking_peer(peer: Peer) -> Ask:
    def ask(views: Sequence[View]) -> Answer:
        found = peer(views[-1])
        return (True, 0.0, 0.0, 0.0) if found is None else (False, *found)

    return ask


def _peers(bands: HeightBands) -> dict[str, tuple[Peer, Sense]]:
    matching = scan_matching(bands)
    return {
        "scan matching, laser": (matching, _laser),
        "scan matching, laser, nonsense": (matching, _nonsense),
        "scan matching, depth from above": (matching, _depth),
        "Open3D FPFH and RANSAC, depth": (feature_matching(bands, fast=False), _depth),
        "Open3D FPFH and FGR, depth": (feature_matching(bands, fast=True), _depth),
    }


def _answers(
    ask: Ask, views: Sequence[View], sense: Sense, together: int, stride: int
) -> list[dict[str, Any]]:
    """Each answer: what became of it, its error, the CPU time, and where it was asked."""
    rng = np.random.default_rng(SEED)
    answers = []
    for end in range(together - 1, len(views), stride):
        question = [sense(v, rng) for v in views[end - together + 1 : end + 1]]
        start = time.thread_time()
        lost, x, y, yaw = ask(question)
        seconds = time.thread_time() - start
        T = views[end].T_map_base
        assert T is not None
        off = math.hypot(x - T[0, 3], y - T[1, 3])
        turned = abs(math.remainder(yaw - yaw_of(T), math.tau)) if math.isfinite(yaw) else math.pi
        is_right = off <= RIGHT_M and turned <= RIGHT_RAD
        became = "lost" if lost else "right" if is_right else "wrong"
        answers.append({"became": became, "off": off, "seconds": seconds, "xy": T[:2, 3]})
    return answers


def _shares(answers: Sequence[dict[str, Any]]) -> dict[str, float]:
    n = max(len(answers), 1)
    off = [a["off"] for a in answers if a["became"] == "right"]
    return {
        "asked": len(answers),
        **{what: sum(a["became"] == what for a in answers) / n for what in BECAME},
        "error_m": float(np.median(off)) if off else math.nan,
        "seconds": float(np.median([a["seconds"] for a in answers])) if answers else math.nan,
    }


BECAME = ("right", "wrong", "lost")


def _by_distance(answers: Sequence[dict[str, Any]], mapped_xy: Array) -> dict[str, Any]:
    apart = np.array([np.linalg.norm(mapped_xy - a["xy"], axis=1).min() for a in answers])
    groups: dict[str, Any] = {}
    low = 0.0
    for high in NEAR_M:
        within = [a for a, d in zip(answers, apart, strict=True) if low <= d < high]
        groups[f"{low:.2f} to {high:.2f} m"] = _shares(within)
        low = high
    return groups


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
TITLES = {
    "senses": "right is within 0.25 m and 10°",
    "peers": "peers (they are never lost)",
    "gone": "depth, low things gone from the map",
    "near": "depth, by the nearest mapped view",
    "elsewhere": "views of another home",
}


def table(result: dict[str, Any]) -> Iterator[str]:
    for part, rows in result.items():
        yield f"{TITLES[part]:36} right wrong  lost  error, m  CPU s"
        for name, r in rows.items():
            yield (
                f"{name:36} {r['right']:5.3f} {r['wrong']:5.3f} {r['lost']:5.3f}"
                f"  {r['error_m']:8.3f} {r['seconds']:6.2f}   of {r['asked']}"
            )
