"""The recordings at hand in other formats, written into a scratch folder by other people's code."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

from afkb.flow import View
from afkb.plugins.protocols import Source

TUM_UNITS_A_METRE = 5000
LARGEST = 65534
_HEADER = re.compile(r"^#.*?<qw>")


def tum_folder(source: Source, folder: Path, count: int) -> Path:
    """The first frames of a recording in TUM's layout: images by OpenCV, poses by Open3D."""
    (folder / "depth").mkdir(parents=True)
    views = [v for v in source.views(0, count) if isinstance(v, View)]
    listed = []
    for view in views:
        assert view.depth_m is not None
        raw = np.round(view.depth_m.astype(np.float64) * TUM_UNITS_A_METRE)
        name = f"depth/{view.stamp:.6f}.png"
        cv2.imwrite(str(folder / name), np.where(raw > LARGEST, 0, raw).astype(np.uint16))
        listed.append(f"{view.stamp:.6f} {name}")
    (folder / "depth.txt").write_text("# timestamp filename\n" + "\n".join(listed) + "\n")
    rows = _open3d_rows(views, folder / "open3d.txt")
    poses = (f"{v.stamp:.6f} {row}" for v, row in zip(views, rows, strict=True))
    (folder / "groundtruth.txt").write_text("\n".join(poses) + "\n")
    camera = views[0].camera
    assert camera is not None
    values = {"fx": camera.fx, "fy": camera.fy, "cx": camera.cx, "cy": camera.cy}
    (folder / "camera.yaml").write_text("".join(f"{k}: {v}\n" for k, v in values.items()))
    return folder


def _open3d_rows(views: list[View], path: Path) -> list[str]:
    """`tx ty tz qx qy qz qw` of each camera, as Open3D's writer of TUM trajectories puts it.

    It numbers the poses in place of stamps, and writes no line break behind its header.
    """
    import open3d as o3d

    poses = []
    for view in views:
        assert view.T_base_camera is not None
        one = o3d.camera.PinholeCameraParameters()
        T_world_camera = view.T_odom_base @ view.T_base_camera
        U, _, Vt = np.linalg.svd(T_world_camera[:3, :3])
        T_world_camera[:3, :3] = U @ Vt
        one.extrinsic = np.linalg.inv(T_world_camera)
        one.intrinsic = o3d.camera.PinholeCameraIntrinsic(640, 480, 585, 585, 320, 240)
        poses.append(one)
    trajectory = o3d.camera.PinholeCameraTrajectory()
    trajectory.parameters = poses
    o3d.io.write_pinhole_camera_trajectory(str(path), trajectory)
    text = _HEADER.sub("", path.read_text())
    return [line.split(" ", 1)[1] for line in text.splitlines() if line.strip()]


def ros1_bag(bag: Path, path: Path) -> Path:
    """A ROS 2 bag as ROS 1's, by the converter of rosbags."""
    words = ["--src", str(bag), "--dst", str(path), "--dst-typestore", "ros1_noetic"]
    code = "from rosbags.convert.__main__ import main; main()"
    subprocess.run([sys.executable, "-c", code, *words], check=True, capture_output=True)
    return path
