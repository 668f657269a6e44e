"""Shows a map in Rerun while it is made."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from afkb.errors import PluginError
from afkb.flow import Detection, TopologicalMap, View
from afkb_rerun.drawing import EXPECTED, draw, log_pose
from afkb_rerun.stream import STAMPS, VIEWS, connect, new_stream, open_window, rerun, save_to

_MILLIMETRES = 1000.0


class RerunViewer:
    """Views, detections and the finished map, in Rerun's window, in a file or on a server.

    `--view rerun` opens a window; `--view rerun=FILE.rrd` writes a file; `--view rerun=URL` sends
    to a viewer that runs there (`rerun+http://host:9876/proxy`).
    """

    name = "rerun"

    def __init__(self) -> None:
        self._stream: Any = None

    def begin(self, uri: str, target: str | None) -> None:
        """Open the window, the file or the connection."""
        stream = new_stream(uri)
        if target is None:
            open_window(stream)
        elif "://" in target:
            connect(stream, target)
        elif target.endswith(".rrd"):
            save_to(stream, Path(target).expanduser())
        else:
            raise PluginError(
                f"--view rerun={target}: name a file that ends in .rrd, or rerun+http://host:port/proxy"
            )
        self._stream = stream

    def show(self, view: View, detections: Sequence[Detection]) -> None:
        """Log what the view saw, under `live/`."""
        stream = self._stream
        stream.set_time(STAMPS, duration=view.stamp)
        stream.set_time(VIEWS, sequence=view.index)
        if view.T_map_base is not None:
            log_pose(stream, "live/robot", view.T_map_base)
        _log_depth(stream, view)
        _log_scan(stream, view)
        _log_detections(stream, detections)

    def end(self, topological_map: TopologicalMap) -> None:
        """Log the finished map, and let go of the stream."""
        self._stream.reset_time()
        draw(self._stream, topological_map)
        self._stream.flush()
        self._stream.disconnect()


def _log_depth(stream: Any, view: View) -> None:
    """The depth image, which Rerun shows as points in space; 0 is nothing."""
    if view.depth_m is None or view.camera is None or view.T_map_base is None:
        return
    rr, camera, T = rerun(), view.camera, view.T_map_camera
    stream.log("live/camera", rr.Transform3D(translation=T[:3, 3], mat3x3=T[:3, :3]))
    lens = rr.Pinhole(image_from_camera=camera.matrix, width=camera.width, height=camera.height)
    stream.log("live/camera/image", lens)
    depth = np.clip(view.depth_m * _MILLIMETRES, 0, 65535).astype(np.uint16)
    stream.log("live/camera/image/depth", rr.DepthImage(depth, meter=_MILLIMETRES))
    if view.color is not None:
        stream.log("live/camera/image/color", rr.Image(view.color).compress(jpeg_quality=75))


def _log_scan(stream: Any, view: View) -> None:
    if view.scan is None or view.T_map_base is None:
        return
    scan, T = view.scan, view.T_map_laser
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges_m))
    good = np.isfinite(scan.ranges_m)
    good &= (scan.ranges_m >= scan.range_min_m) & (scan.ranges_m <= scan.range_max_m)
    ranges = scan.ranges_m[good].astype(np.float64)
    flat = np.stack([ranges * np.cos(angles[good]), ranges * np.sin(angles[good])], axis=1)
    points = np.column_stack([flat, np.zeros(len(flat))]) @ T[:3, :3].T + T[:3, 3]
    stream.log("live/scan", rerun().Points3D(points, radii=0.02))


def _log_detections(stream: Any, detections: Sequence[Detection]) -> None:
    rr = rerun()
    solid = [d for d in detections if d.segment_xy is None]
    if not solid:
        stream.log("live/detections", rr.Clear(recursive=False))
        return
    turns = [(0.0, 0.0, np.sin(d.box.yaw / 2), np.cos(d.box.yaw / 2)) for d in solid]
    boxes = rr.Boxes3D(
        centers=[d.box.center_xyz for d in solid],
        sizes=[d.box.size_xyz for d in solid],
        quaternions=turns,
        colors=EXPECTED,
        labels=[max(d.affordances, key=lambda a: (d.affordances[a], a)) for d in solid],
        show_labels=False,
    )
    stream.log("live/detections", boxes)
