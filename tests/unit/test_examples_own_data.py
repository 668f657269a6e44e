"""The examples for people's own recordings, run on a few frames of a simulated room."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import cv2
import numpy as np
import pytest

from afkb.flow import View
from afkb_simulation.source import open_world
from bag_samples import CAMERA_FRAME, BagWriter, put_depth
from tum_samples import write_poses

EXAMPLES = Path(__file__).parents[2] / "examples"
WORLD = """
name: study
rooms: [{name: study, category: Office, rectangle: [0, 0, 4, 3]}]
things: [{name: desk, shape: table, category: Desk, at: [2.6, 1.5]}]
robot: {camera: {width: 160, height: 120, height_m: 1.3, pitch_down_deg: 30}, laser: null}
odometry_drift: {along_per_m: 0, yaw_per_m: 0, yaw_per_rad: 0}
tour:
  waypoints: [{name: a, at: [0.6, 1.5], yaw_deg: 0, looks_deg: [0, 20]}]
"""


def example(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def views(tmp_path_factory: pytest.TempPathFactory) -> list[View]:
    path = tmp_path_factory.mktemp("worlds") / "study.world.yaml"
    path.write_text(WORLD)
    return [v for v in open_world(str(path)).views() if isinstance(v, View)]


def test_own_rgbd_folder(
    views: list[View], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Poses are the robot's, with the camera mounted on it: the desk comes out at its height."""
    folder = tmp_path / "mine"
    (folder / "depth").mkdir(parents=True)
    listed, poses = [], []
    for view in views:
        assert view.depth_m is not None
        cv2.imwrite(
            str(folder / f"depth/{view.index}.png"), (view.depth_m * 5000).astype(np.uint16)
        )
        listed.append(f"{view.stamp} depth/{view.index}.png")
        poses.append((view.stamp, *_pose(view.T_odom_base)))
    (folder / "depth.txt").write_text("\n".join(listed))
    write_poses(folder / "odometry.txt", poses)
    with (folder / "odometry.txt").open("a") as file:
        file.write("3 lost\n")
    camera, mounted = views[0].camera, views[0].T_base_camera
    assert camera is not None
    assert mounted is not None
    example("own_rgbd_folder").main(
        str(folder),
        str(tmp_path / "map"),
        f"intrinsics={camera.fx},{camera.fy},{camera.cx},{camera.cy}",
        "mounted=" + ",".join(f"{v:.9f}" for v in _pose(mounted)),
    )
    printed = capsys.readouterr().out
    assert f"{len(views)} frames" in printed
    run = json.loads((tmp_path / "map" / "run.json").read_text())
    assert any("odometry.txt: 1 line left out as unreadable" in note for note in run["notes"])
    heights = [float(line.split(": ")[1][:4]) for line in printed.splitlines() if "m high" in line]
    assert min(abs(height - 0.75) for height in heights) < 0.03


def _pose(T: np.ndarray | None) -> list[float]:
    from scipy.spatial.transform import Rotation

    assert T is not None
    return [*T[:3, 3], *Rotation.from_matrix(T[:3, :3]).as_quat()]


def test_own_ros_bag(views: list[View], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = BagWriter(ros1=True)
    for view in views:
        assert view.depth_m is not None
        assert view.camera is not None
        t = 1 + view.stamp
        put_depth(bag, t, view.depth_m, "16UC1")
        bag.camera_info(t, view.camera.fx, size=(view.camera.width, view.camera.height))
        x, y, z, *xyzw = _pose(view.T_odom_base)
        bag.tf(t, "odom", "base_link", (x, y, z), _quaternion(xyzw))
    x, y, z, *xyzw = _pose(views[0].T_base_camera)
    bag.tf(1, "base_link", CAMERA_FRAME, (x, y, z), _quaternion(xyzw), static=True)
    example("own_ros_bag").main(str(bag.write(tmp_path / "mine.bag")), str(tmp_path / "map"))
    printed = capsys.readouterr().out.splitlines()
    assert any("m²" in line for line in printed)
    assert any(line.endswith(" things") for line in printed)


def _quaternion(xyzw: list[float]) -> tuple[float, float, float, float]:
    qx, qy, qz, qw = xyzw
    return qx, qy, qz, qw
