"""Loops closed by what things afford, with depth and odometry only; what each of them corrected.

    python -m bench.mapping loops [--homes FOLDER] [--json]

*Odometry*: views where wheel odometry alone puts them, so that loops have to do all the work.
*Registered*: as the run places them. A closure is false if its relative pose is off by more than
0.25 m or 10 degrees of the true one.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LoopProposal
from afkb.inference import network_of
from afkb_mapping.geometry import T_from_xy_yaw, inverse
from afkb_mapping.loops.closing import close_loops
from afkb_mapping.loops.survey import apart
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import Home, data_folder, homes_in
from bench.mapping.altered import AlteringHost, without_laser

Array = NDArray[np.float64]

FALSE_M, FALSE_RAD = 0.25, math.radians(10)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What homes: folders with `bag/` and `truth.json`."""
    parser.add_argument("--homes", type=Path, default=data_folder() / "homes")
    parser.add_argument("--stride", type=int, default=1)


def run(args: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """What closing loops came to, by home and by where views were placed before."""
    host = AlteringHost(without_laser)
    found = {}
    for home in homes_in(args.homes, host):
        views = _remembered(home, host, args.stride)
        by_odometry = _by_odometry(views)
        for name, placed in (("odometry", by_odometry), ("registered", views)):
            found[f"{home.name}, {name}"] = _closed(home, placed, host)
    return found


def _remembered(home: Home, host: AlteringHost, stride: int) -> list[RememberedView]:
    with tempfile.TemporaryDirectory() as scratch:
        out = Path(scratch) / "map"
        make_map(host, Settings(uri=str(home.folder / "bag"), out=out, stride=stride))
        return list(memory_of(out).views)


def _by_odometry(views: Sequence[RememberedView]) -> list[RememberedView]:
    """Views where odometry alone puts them; the first one as it is."""
    T_map_odom = views[0].T_map_base @ inverse(views[0].view.T_odom_base)
    return [v.moved_to(T_map_odom @ v.view.T_odom_base) for v in views]


def _closed(home: Home, views: Sequence[RememberedView], host: AlteringHost) -> dict[str, Any]:
    true = _true_poses(home, views)
    begun = time.thread_time()
    closed = close_loops(views, network_of(host.knowledge_base))
    seconds = time.thread_time() - begun
    accepted = [p for p in closed.proposals if p.accepted]
    at = {v.view.index: T for v, T in zip(views, true, strict=True)}
    rejected = Counter(
        f"{p.kind}: {p.reason.split(':')[0]}" for p in closed.proposals if not p.accepted
    )
    return {
        "before": _errors([v.T_map_base for v in views], true),
        "after": _errors(closed.poses, true),
        "closures": [_told(p, at) for p in accepted],
        "false": sum(_told(p, at)["false"] for p in accepted),
        "confirmed": closed.confirmed,
        "rejected": dict(rejected),
        "cpu_seconds": seconds,
    }


def _true_poses(home: Home, views: Sequence[RememberedView]) -> list[Array]:
    told = {round(v["stamp"], 3): v for v in home.truth["views"]}
    true = [told[round(v.view.stamp, 3)] for v in views]
    world = [T_from_xy_yaw(v["x"], v["y"], v["yaw"]) for v in true]
    return [views[0].T_map_base @ inverse(world[0]) @ T for T in world]


def _told(proposal: LoopProposal, true: dict[int, Array]) -> dict[str, Any]:
    assert proposal.relative is not None
    right = inverse(true[proposal.earlier_view]) @ true[proposal.view]
    off_m, off_rad = apart(right, T_from_xy_yaw(*proposal.relative))
    return {
        "view": proposal.view,
        "earlier_view": proposal.earlier_view,
        "by": proposal.kind.value,
        "corrected_m": proposal.corrected_m,
        "corrected_rad": proposal.corrected_rad,
        "error_m": off_m,
        "error_rad": off_rad,
        "false": off_m > FALSE_M or off_rad > FALSE_RAD,
    }


def _errors(poses: Sequence[Array], true: Sequence[Array]) -> dict[str, float]:
    off = [float(np.hypot(*(a[:2, 3] - b[:2, 3]))) for a, b in zip(poses, true, strict=True)]
    return {"mean_m": float(np.mean(off)), "greatest_m": max(off), "end_m": off[-1]}


def table(result: dict[str, dict[str, Any]]) -> Iterator[str]:
    """A line a home and way of placing; what each closure corrected below it."""
    yield f"{'':28} mean, m greatest, m  end, m"
    for name, found in result.items():
        for when in ("before", "after"):
            e = found[when]
            yield (
                f"{name + ', ' + when:28} {e['mean_m']:7.3f} {e['greatest_m']:11.3f} "
                f"{e['end_m']:7.3f}"
            )
        yield (
            f"{'':28} {len(found['closures'])} closures, {found['false']} false, "
            f"{found['confirmed']} more confirm; {found['cpu_seconds']:.1f} s of CPU"
        )
        for c in found["closures"]:
            yield (
                f"{'':28} view {c['view']} to {c['earlier_view']} by {c['by']}: corrects "
                f"{c['corrected_m']:.3f} m, {math.degrees(c['corrected_rad']):.1f}°; "
                f"off by {c['error_m']:.3f} m, {math.degrees(c['error_rad']):.1f}°"
            )
        for reason, count in sorted(found["rejected"].items()):
            yield f"{'':28} {count} rejected: {reason}"
