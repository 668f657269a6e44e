"""Whether a recording says the same in another format, written by other people's code.

    python -m bench.sources agreement [--frames N]

The real kitchen as a TUM folder (depth images by OpenCV, poses by Open3D's writer, which keeps six
digits), the rendered home as a ROS 1 bag (by the converter of rosbags). Told: frames, pixels of
depth that differ, the farthest that a camera or laser is from where the direct source puts it.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Source
from bench.detectors.data import NoData, data_folder
from bench.sources.converted import ros1_bag, tum_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """How much is compared."""
    parser.add_argument("--frames", type=int, default=120)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What differs, by recording."""
    data = data_folder()
    kitchen, bag = data / "redkitchen", data / "homes" / "pomaria" / "bag"
    host, found = PluginHost(), {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        if kitchen.is_dir():
            direct = host.open_source(str(kitchen))
            tum = host.open_source(str(tum_folder(direct, folder / "tum", args.frames)))
            found["7-Scenes folder as TUM folder"] = compared(direct, tum, args.frames)
        if bag.is_dir():
            bag1 = host.open_source(str(ros1_bag(bag, folder / "home.bag")))
            direct = host.open_source(str(bag))
            found["ROS 2 bag as ROS 1 bag"] = compared(direct, bag1, args.frames)
    if not found:
        raise NoData(f"no redkitchen or homes/pomaria in {data}")
    return found


def compared(first: Source, second: Source, frames: int) -> dict[str, float]:
    """Frames read by both, frames that only one can read, and what differs in the others."""
    both = only_one = pixels = 0
    moved = beams = 0.0
    for a, b in zip(first.views(0, frames), second.views(0, frames), strict=True):
        if not (isinstance(a, View) and isinstance(b, View)):
            only_one += isinstance(a, View) != isinstance(b, View)
            continue
        both += 1
        pixels += int((_depth(a) != _depth(b)).sum())
        moved = max(moved, _apart(a, b, "T_base_camera"), _apart(a, b, "T_base_laser"))
        if a.scan is not None and b.scan is not None:
            beams = max(beams, float((a.scan.ranges_m != b.scan.ranges_m).sum()))
    return {
        "frames": both,
        "read by one alone": only_one,
        "pixels that differ": pixels,
        "beams that differ": beams,
        "sensors apart, m": round(moved, 7),
    }


def _depth(view: View) -> Any:
    assert view.depth_m is not None
    return view.depth_m


def _apart(a: View, b: View, mounted: str) -> float:
    """How far a point 1 m before the sensor is from itself, m."""
    T_a, T_b = getattr(a, mounted), getattr(b, mounted)
    if T_a is None or T_b is None:
        return 0.0
    ahead = np.array([0.0, 0.0, 1.0, 1.0])
    return float(np.linalg.norm(a.T_odom_base @ T_a @ ahead - b.T_odom_base @ T_b @ ahead))


def table(result: dict[str, dict[str, float]]) -> Iterable[str]:
    """A line a recording."""
    for name, found in result.items():
        yield name + ": " + ", ".join(f"{key} {value:g}" for key, value in found.items())
