"""How many frames a CPU second each source reads, beside the plainest way to get the same arrays.

    python -m bench.sources reading [--frames N] [--rounds N]

What others read is the depth image alone, without a pose and without asking whether the file is
whole: OpenCV's `imread`, Open3D's `read_image`, rosbags' reader with OpenCV's decoder. Each round
reads the same frames with each reader in turn; depth must be equal. The first round warms the disk
cache and is not counted. Seconds are of CPU. Trajectories: lines a second, beside Open3D's reader
of the same file.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Source
from afkb_mapping.recordings.pose_file import Damaged, read_poses
from bench.detectors.data import NoData, data_folder
from bench.sources.converted import ros1_bag, tum_folder

Depths = Iterator[NDArray[np.float32]]
TRAJECTORY_LINES = 20_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """How much is read, how often."""
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=5)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Frames a CPU second (median, least, most) of each reader, by format."""
    data = data_folder()
    kitchen, bag = data / "redkitchen", data / "homes" / "pomaria" / "bag"
    if not kitchen.is_dir() or not bag.is_dir():
        raise NoData(f"no redkitchen and homes/pomaria in {data}")
    host = PluginHost()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        tum = tum_folder(host.open_source(str(kitchen)), folder / "tum", args.frames)
        bag1 = ros1_bag(bag, folder / "home.bag")
        result = {
            "7-Scenes folder": _measured(_images(host, kitchen, "*.depth.png", 1000), args),
            "TUM folder": _measured(_images(host, tum, "depth/*.png", 5000), args),
            "ROS 2 bag": _measured(_bag(host, bag), args),
            "ROS 1 bag": _measured(_bag(host, bag1), args),
        }
        result["TUM trajectory, lines"] = _trajectory(folder / "long.txt", args)
    return result


Readers = dict[str, Callable[[int], Depths]]


def _images(host: PluginHost, folder: Path, pattern: str, scale: float) -> Readers:
    def files(count: int) -> list[str]:
        return [str(p) for p in sorted(folder.glob(pattern))[:count]]

    def opencv(count: int) -> Depths:
        for file in files(count):
            yield _metres(cv2.imread(file, cv2.IMREAD_UNCHANGED), scale)

    def open3d(count: int) -> Depths:
        import open3d as o3d

        for file in files(count):
            yield _metres(np.asarray(o3d.io.read_image(file)), scale)

    source = host.open_source(str(folder))
    return {"afkb": lambda count: _depths(source, count), "OpenCV": opencv, "Open3D": open3d}


def _bag(host: PluginHost, path: Path) -> Readers:
    def rosbags(count: int) -> Depths:
        from rosbags.highlevel import AnyReader

        with AnyReader([path]) as reader:
            depth = [c for c in reader.connections if c.topic.endswith("compressedDepth")]
            for at, (connection, _, raw) in enumerate(reader.messages(depth)):
                if at == count:
                    return
                png = reader.deserialize(raw, connection.msgtype).data[12:]
                yield _metres(cv2.imdecode(png, cv2.IMREAD_UNCHANGED), 1000)

    source = host.open_source(str(path))
    return {"afkb": lambda count: _depths(source, count), "rosbags and OpenCV": rosbags}


def _depths(source: Source, count: int) -> Depths:
    for view in source.views(0, count):
        assert isinstance(view, View)
        assert view.depth_m is not None
        yield view.depth_m


def _metres(pixels: NDArray[Any], scale: float) -> NDArray[np.float32]:
    depth_m = pixels.astype(np.float32) / np.float32(scale)
    depth_m[pixels == 65535] = 0
    return depth_m


def _measured(readers: Readers, args: argparse.Namespace) -> dict[str, Any]:
    rates: dict[str, list[float]] = {name: [] for name in readers}
    sums: set[tuple[int, float]] = set()
    for _ in range(args.rounds + 1):
        for name, read in readers.items():
            begun = time.process_time()
            count, total = 0, 0.0
            spent = 0.0
            for depth_m in read(args.frames):
                spent += time.process_time() - begun
                count, total = count + 1, total + float(depth_m.sum(dtype=np.float64))
                begun = time.process_time()
            rates[name].append(count / spent)
            sums.add((count, round(total, 3)))
    told: dict[str, Any] = {name: _spread(found[1:]) for name, found in rates.items()}
    return {"equal": len(sums) == 1, "frames": max(n for n, _ in sums), "per_second": told}


def _trajectory(path: Path, args: argparse.Namespace) -> dict[str, Any]:
    import open3d as o3d

    rng = np.random.default_rng(0)
    poses = np.column_stack([rng.normal(size=(TRAJECTORY_LINES, 3)), _quaternions(rng)])
    rows = (f"{0.01 * i:.4f} " + " ".join(f"{v:.6f}" for v in p) for i, p in enumerate(poses))
    path.write_text("\n".join(rows) + "\n")

    def ours() -> int:
        return len(read_poses(path, Damaged(path)))

    def theirs() -> int:
        return len(o3d.io.read_pinhole_camera_trajectory(str(path)).parameters)

    rates: dict[str, list[float]] = {"afkb": [], "Open3D": []}
    counts = set()
    for _ in range(args.rounds + 1):
        for name, read in (("afkb", ours), ("Open3D", theirs)):
            begun = time.process_time()
            counts.add(read())
            rates[name].append(TRAJECTORY_LINES / (time.process_time() - begun))
    told = {name: _spread(found[1:]) for name, found in rates.items()}
    return {"equal": counts == {TRAJECTORY_LINES}, "frames": TRAJECTORY_LINES, "per_second": told}


def _quaternions(rng: np.random.Generator) -> NDArray[np.float64]:
    q = rng.normal(size=(TRAJECTORY_LINES, 4))
    return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))


def _spread(rates: list[float]) -> dict[str, float]:
    named = {"median": np.median(rates), "least": min(rates), "most": max(rates)}
    return {name: round(float(value), 1) for name, value in named.items()}


def table(result: dict[str, Any]) -> Iterable[str]:
    """A line a format and reader."""
    yield f"{'format':24}{'reader':22}{'a CPU s':>10}{'least':>10}{'most':>10}   depth equal"
    for name, found in result.items():
        for reader, rate in found["per_second"].items():
            numbers = "".join(f"{rate[k]:10,.0f}" for k in ("median", "least", "most"))
            yield f"{name:24}{reader:22}{numbers}   {'yes' if found['equal'] else 'NO'}"
