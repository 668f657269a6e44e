"""How far poses are off, with a laser and with depth and odometry only; what closing loops mended.

    python -m bench.mapping trajectory [--homes FOLDER] [--maps] [--json]

Absolute trajectory error, the first view's pose given: distance of every view from where it truly
was. *Registered*: as views are placed one by one; quick, since no detector is needed. *Map*: as
the finished map has it, loops closed (with `--maps`); run.json's closures are listed.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View
from afkb_mapping.placing.levelling import level
from afkb_mapping.placing.registration import ScanRegistration
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import Home, data_folder, homes_in
from bench.mapping.altered import Alter, AlteringHost, without_laser
from bench.trajectory import SAMPLED_VIEWS, absolute_errors

Array = NDArray[np.float64]


def as_it_is(frames: Any) -> Any:
    """The recording unchanged."""
    return frames


SENSES: dict[str, Alter] = {"laser": as_it_is, "depth only": without_laser}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What homes: folders with `bag/` and `truth.json`."""
    parser.add_argument("--homes", type=Path, default=data_folder() / "homes")
    parser.add_argument("--maps", action="store_true", help="make whole maps, with loops closed")
    parser.add_argument("--stride", type=int, default=1)


def run(args: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """Errors by home and by what was sensed; raises `NoData` where there is no home."""
    homes = homes_in(args.homes, AlteringHost(as_it_is))
    return {
        f"{home.name}, {sense}": _of_home(home, AlteringHost(alter), args)
        for home in homes
        for sense, alter in SENSES.items()
    }


def _of_home(home: Home, host: AlteringHost, args: argparse.Namespace) -> dict[str, Any]:
    source = host.open_source(str(home.folder / "bag"))
    views = [v for v in source.views(stride=args.stride) if isinstance(v, View)]
    stamps = np.array([v.stamp for v in views])
    errors = _against(home.truth)
    used, registered, milliseconds = registered_poses(views, source.gravity_aligned)
    found: dict[str, Any] = {
        "views": len(views),
        "odometry": errors(stamps, [v.T_odom_base for v in views]),
        "registered": errors(np.array([v.stamp for v in used]), registered),
        "lost": len(views) - len(used),
        "ms_per_view": float(np.median(milliseconds)),
    }
    return found | (_map_of(home, host, args.stride) if args.maps else {})


def registered_poses(
    views: list[View], upright: bool
) -> tuple[list[View], list[Array], list[float]]:
    """The views that registration places, where (4, 4), and the CPU time that each took, ms."""
    sample = views[:: max(1, len(views) // SAMPLED_VIEWS)]
    registration = ScanRegistration(level(sample, upright).T_map_source)
    used, poses, milliseconds = [], [], []
    for view in views:
        begun = time.thread_time()
        try:
            poses.append(registration.place(view).T_map_base)
        except BadFrame:
            continue
        used.append(view)
        milliseconds.append(1e3 * (time.thread_time() - begun))
    registration.end()
    kept = [k for k, view in enumerate(used) if view.index not in registration.held.withdrawn]
    return [used[k] for k in kept], [poses[k] for k in kept], milliseconds


def _map_of(home: Home, host: AlteringHost, stride: int) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as scratch:
        settings = Settings(uri=str(home.folder / "bag"), out=Path(scratch) / "map", stride=stride)
        result = make_map(host, settings)
    trajectory = np.array(result.topological_map.trajectory)
    poses = list(trajectory[:, 1:17].reshape(-1, 4, 4))
    loops: Any = result.run.get("loops", [])
    return {
        "map": _against(home.truth)(trajectory[:, 0], poses),
        "closures": [loop for loop in loops if loop["accepted"]],
        "proposals_rejected": sum(not loop["accepted"] for loop in loops),
        "predictions_come_true": len(result.topological_map.closures),
    }


def _against(truth: dict[str, Any]) -> Callable[[Array, list[Array]], dict[str, float]]:
    def errors(stamps: Array, poses: list[Array]) -> dict[str, float]:
        off = absolute_errors(stamps, np.linalg.inv(poses[0]) @ np.array(poses), truth)
        return {
            "mean_m": float(off[:, 0].mean()),
            "greatest_m": float(off[:, 0].max()),
            "end_m": float(off[-1, 0]),
            "greatest_deg": float(off[:, 1].max()),
        }

    return errors


def table(result: dict[str, dict[str, Any]]) -> Iterator[str]:
    """A line a home, sense and way; what each closure corrected below it."""
    yield f"{'':36}  mean, m greatest, m  end, m  greatest, °"
    for name, found in result.items():
        for way in ("odometry", "registered", "map"):
            if way in found:
                e = found[way]
                yield (
                    f"{name + ', ' + way:36}  {e['mean_m']:7.3f} {e['greatest_m']:11.3f}"
                    f" {e['end_m']:7.3f} {e['greatest_deg']:12.2f}"
                )
        yield f"{'':36}  {found['views']} views, {found['ms_per_view']:.0f} ms of CPU each"
        if "map" in found:
            yield f"{'':36}  {found['proposals_rejected']} proposed closures rejected"
        for loop in found.get("closures", ()):
            yield (
                f"{'':36}  view {loop['view']} to {loop['earlier_view']} by {loop['by']}:"
                f" {loop['corrected_m']:.3f} m, {np.degrees(loop['corrected_rad']):.2f}°"
            )
