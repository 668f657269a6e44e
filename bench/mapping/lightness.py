"""How light a map is: the same recording as a TSDF and as a voxel map beside it.

    python -m bench.mapping lightness [--recording SOURCE] [--stride N]

All three are built from the same views at the same poses, those of our map. Open3D's voxel block
grid integrates depth into a truncated signed distance field; its voxel grid keeps the cells of 5 cm
in which points lie. Seconds are of CPU, without reading the recording. Bytes: of ours `map.json`
with the grid, and the whole folder (RDF, report, what continuing needs); of the field packed, and
as Open3D saves it. What each can answer is asked, not claimed: of ours by its own commands, of the
others by what their cells hold.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import AfkbError
from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb.store import load
from afkb_mapping.geometry import back_project, transform
from afkb_mapping.routes.ends import Kind, end_of
from afkb_mapping.routes.planner import Planner
from afkb_mapping.routes.route_map import RouteMap
from afkb_mapping.routes.search import search
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import data_folder

Array = NDArray[np.float64]

TSDF_M, VOXEL_M = 0.02, 0.05
"""Usual cells: a Kinect's noise at 2 m and more; what nav2's voxel layer has."""
FARTHEST_M = 4.0
"""Depth beyond is left out, of ours too."""
BLOCK, BLOCKS = 16, 40_000
SOUGHT = "Mug"
SURFACE = "how far is the next surface from a point of space?"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The recording, with depth."""
    bag = data_folder() / "homes" / "merom" / "bag"
    default = str(bag) if bag.exists() else "world:paper_home"
    parser.add_argument("--recording", default=default)
    parser.add_argument("--stride", type=int, default=1)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Bytes, seconds and answers of each kind of map."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        ours = _ours(args.recording, args.stride, folder / "map")
        views = _views(args.recording, args.stride, folder / "map")
        return {
            "recording": args.recording,
            "views": len(views),
            "affordance map": ours,
            "TSDF, 2 cm": _tsdf(views, folder),
            "voxels, 5 cm": _voxels(views, folder),
        }


def _ours(recording: str, stride: int, out: Path) -> dict[str, Any]:
    host = PluginHost()
    start = time.process_time()
    settings = Settings(uri=recording, out=out, stride=stride)
    stages = make_map(host, settings).run["seconds"]
    assert isinstance(stages, dict)
    seconds = time.process_time() - start - float(stages.get("read", 0.0))
    whole = sum(f.stat().st_size for f in out.rglob("*") if f.is_file())
    return {
        "bytes": (out / "map.json").stat().st_size + (out / "occupancy.pgm").stat().st_size,
        "bytes_of_all": whole,
        "seconds": seconds,
        "answers": _answers(out, host),
    }


def _answers(out: Path, host: PluginHost) -> dict[str, str]:
    """What the stored map says to each question, in brief."""
    stored, known = load(out), RouteMap.read(out)
    planner, kb = Planner.of(known, 0.2), host.knowledge_base
    rooms = list(known.rooms.values())
    supports = sum("SupportAbility" in stored.names(n, "afn:affords") for n in _things(stored))
    contain = sum("ContainAbility" in stored.names(n, "afn:affords") for n in _things(stored))
    start = end_of(next(iter(known.places)), known, kb)
    try:
        found = search(planner, kb, start, Kind(SOUGHT))
        sought = f"{len(found.places)} places, {found.order.expected_m:.1f} m expected"
    except AfkbError as error:
        sought = str(error)
    moves = sum(stored.name(n, "afn:movability") == "Dynamic" for n in _things(stored))
    return {
        "may a robot of 0.2 m stand there?": f"{planner.where.free.mean():.0%} of the grid",
        "which rooms, and what for?": ", ".join(f"{next(iter(r.belief))}" for r in rooms),
        "what supports, what contains?": f"{supports} and {contain} things",
        "what of that moves?": f"{moves} things",
        "what is there unseen?": f"{sum(not t.seen for t in known.things.values())} things",
        f"where to look for a {SOUGHT}?": sought,
        SURFACE: f"in the plan, to {known.grid.grid.resolution_m:.2f} m",
    }


def _things(stored: Any) -> list[Any]:
    return list(stored.instances("ObservedEntity"))


def _views(recording: str, stride: int, folder: Path) -> list[tuple[View, Array]]:
    """Views with depth, and where our map has their cameras (4, 4)."""
    rows = np.loadtxt(folder / "state" / "trajectory.txt", ndmin=2)
    poses = {round(row[0], 6): row[1:].reshape(4, 4) for row in rows}
    source = PluginHost().open_source(recording, {})
    found = []
    for view in source.views(stride=stride):
        T = poses.get(round(view.stamp, 6)) if isinstance(view, View) else None
        if T is not None and view.depth_m is not None and view.T_base_camera is not None:
            found.append((view, T @ view.T_base_camera))
    return found


def _tsdf(views: list[tuple[View, Array]], folder: Path) -> dict[str, Any]:
    import open3d as o3d

    core, start = o3d.core, time.process_time()
    grid = o3d.t.geometry.VoxelBlockGrid(
        ("tsdf", "weight"),
        (core.float32, core.float32),
        ((1,), (1,)),
        TSDF_M,
        BLOCK,
        BLOCKS,
        core.Device("CPU:0"),
    )
    for view, T in views:
        assert view.camera is not None and view.depth_m is not None
        depth = o3d.t.geometry.Image(core.Tensor(view.depth_m))
        K, T_camera_map = core.Tensor(view.camera.matrix), core.Tensor(np.linalg.inv(T))
        blocks = grid.compute_unique_block_coordinates(depth, K, T_camera_map, 1.0, FARTHEST_M)
        grid.integrate(blocks, depth, K, T_camera_map, 1.0, FARTHEST_M)
    seconds = time.process_time() - start
    grid.save(str(folder / "tsdf.npz"))
    with np.load(folder / "tsdf.npz") as stored:
        np.savez_compressed(folder / "packed.npz", **stored)
    return {
        "bytes": (folder / "packed.npz").stat().st_size,
        "bytes_of_all": (folder / "tsdf.npz").stat().st_size,
        "seconds": seconds,
        "answers": {
            "may a robot of 0.2 m stand there?": "where surfaces are, not what is free",
            SURFACE: f"to {TSDF_M} m",
        },
    }


def _voxels(views: list[tuple[View, Array]], folder: Path) -> dict[str, Any]:
    import open3d as o3d

    start = time.process_time()
    cloud = o3d.geometry.PointCloud()
    for view, T in views:
        assert view.camera is not None and view.depth_m is not None
        points = back_project(view.depth_m, view.camera).reshape(-1, 3)
        near = transform(T, points[points[:, 2] < FARTHEST_M].astype(np.float64))
        one = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(near))
        cloud += one.voxel_down_sample(VOXEL_M)
    grid = o3d.geometry.VoxelGrid.create_from_point_cloud(cloud, VOXEL_M)
    seconds = time.process_time() - start
    o3d.io.write_voxel_grid(str(folder / "voxels.ply"), grid)
    size = (folder / "voxels.ply").stat().st_size
    said = f"{len(grid.get_voxels())} cells are not free, of the others nothing is told"
    return {
        "bytes": size,
        "bytes_of_all": size,
        "seconds": seconds,
        "answers": {"may a robot of 0.2 m stand there?": said, SURFACE: f"to {VOXEL_M} m"},
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """Bytes and seconds, then what each answers."""
    yield f"{result['recording']}: {result['views']} views"
    yield f"{'':16} {'MB':>8} {'MB, all':>10} {'CPU s':>7}"
    kinds = [k for k, v in result.items() if isinstance(v, dict)]
    for kind in kinds:
        r = result[kind]
        megabytes = r["bytes"] / 1e6, r["bytes_of_all"] / 1e6
        yield f"{kind:16} {megabytes[0]:8.3f} {megabytes[1]:10.3f} {r['seconds']:7.1f}"
    for question in result[kinds[0]]["answers"]:
        yield question
        for kind in kinds:
            yield f"  {kind:16} {result[kind]['answers'].get(question, 'nothing in it tells')}"
