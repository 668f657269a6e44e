"""Errors of a laser robot's relative poses, by odometry, after registration, with loops closed.

    python -m bench.mapping relations [--log LOG] [--relations FILE] [--json]

As Kuemmerle et al. 2009 measure: for each surveyed relation between two scan times, how far the
relative pose of these two scans is off, in translation and rotation. For scale, published of this
log: scan matching 0.220 m, graph mapping 0.031 m (mean).
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb.inference import network_of
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import inverse
from afkb_mapping.loops.closing import close_loops
from bench.detectors.data import NoData, data_folder
from bench.mapping.trajectory import registered_poses
from bench.trajectory import relation_errors

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """A placed view in which nothing was detected: a laser scan."""

    view: View
    detections: Sequence[Detection] = ()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The log, and the relations that were surveyed in it."""
    lasers = data_folder() / "lasers"
    parser.add_argument("--log", type=Path, default=lasers / "intel.log")
    parser.add_argument("--relations", type=Path, default=lasers / "intel.relations")
    parser.add_argument(
        "--option", action="append", metavar="KEY=VALUE", help="of the source; default poses=odom"
    )


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Errors in each state; raises `NoData` where there is no log or no relations."""
    for path in (args.log, args.relations):
        if not path.is_file():
            raise NoData(f"{path}: no such file; name one, or set AFKB_DATA")
    host = PluginHost()
    options = dict(o.split("=", 1) for o in args.option or ["poses=odom"])
    source = host.open_source(str(args.log), options)
    recorded = [v for v in source.views() if isinstance(v, View)]
    views, registered, milliseconds = registered_poses(recorded, source.gravity_aligned)
    seen = [Seen(replace(v, T_map_base=T)) for v, T in zip(views, registered, strict=True)]
    begun = time.thread_time()
    closed = close_loops(seen, network_of(host.knowledge_base))
    seconds = time.thread_time() - begun
    stamps, relations = np.array([v.stamp for v in views]), np.loadtxt(args.relations, ndmin=2)
    ways = {
        "odometry": [v.T_odom_base for v in views],
        "registered": registered,
        "loops closed": closed.poses,
    }
    errors = {name: relation_errors(stamps, _from_first(T), relations) for name, T in ways.items()}
    accepted = [p for p in closed.proposals if p.accepted]
    return {
        "views": len(views),
        "lost": len(recorded) - len(views),
        "relations": len(relations),
        "errors": {name: _summary(e) for name, e in errors.items()},
        "closures": [
            {
                "view": p.view,
                "earlier_view": p.earlier_view,
                "corrected_m": p.corrected_m,
                "corrected_rad": p.corrected_rad,
            }
            for p in accepted
        ],
        "confirmed": closed.confirmed,
        "rejected": dict(
            Counter(p.reason.split(":")[0] for p in closed.proposals if not p.accepted)
        ),
        "registration_cpu_s": sum(milliseconds) / 1e3,
        "closing_cpu_s": seconds,
    }


def _from_first(poses: Sequence[Array]) -> Array:
    from_first: Array = inverse(poses[0]) @ np.array(poses)
    return from_first


def _summary(errors: Array) -> dict[str, float]:
    metres, degrees = errors.T
    return {
        "compared": len(errors),
        "mean_m": float(metres.mean()),
        "sd_m": float(metres.std()),
        "greatest_m": float(metres.max()),
        "mean_deg": float(degrees.mean()),
        "sd_deg": float(degrees.std()),
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line a state; then what was closed."""
    yield (
        f"{result['views']} scans, {result['lost']} skipped as lost, "
        f"{result['relations']} relations"
    )
    yield f"{'':14} compared  mean, m  sd, m  greatest, m  mean, °  sd, °"
    for name, e in result["errors"].items():
        yield (
            f"{name:14} {e['compared']:8d} {e['mean_m']:8.4f} {e['sd_m']:6.3f}"
            f" {e['greatest_m']:12.3f} {e['mean_deg']:8.3f} {e['sd_deg']:6.3f}"
        )
    corrected = [c["corrected_m"] for c in result["closures"]] or [0.0]
    yield (
        f"{len(result['closures'])} closures, by {np.median(corrected):.3f} m (median), "
        f"{max(corrected):.3f} m at most; {result['confirmed']} more confirm"
    )
    for reason, count in sorted(result["rejected"].items()):
        yield f"{count} rejected: {reason}"
    yield (
        f"CPU: registration {result['registration_cpu_s']:.1f} s, "
        f"loops {result['closing_cpu_s']:.1f} s"
    )
