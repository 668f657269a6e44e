"""Which tf frames play base and odometry, and where the sensors sit between them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb_mapping.optical import T_BODY_OPTICAL, T_OPTICAL_BODY
from afkb_rosbag.index import Index, Odometry
from afkb_rosbag.options import BagOptions
from afkb_rosbag.transforms import FrameTree, inverse

_BASES = ("base_footprint", "base_link", "base")
_ODOM = "odom"


@dataclass(frozen=True)
class Frames:
    """Named frames of the recording, with the tree they hang in.

    Without a `base` (a hand-held camera) the camera's body stands in for it, else the laser.
    """

    tree: FrameTree
    odom: str
    base: str | None
    camera: str | None
    laser: str | None

    def T_odom_base(self, stamp: int) -> NDArray[np.float64]:
        """Pose of the base at a stamp (ns), (4, 4), m; `BadFrame` in a tf gap."""
        if self.base is not None:
            return self.tree.lookup(self.odom, self.base, stamp)
        if self.camera is not None:
            return self.tree.lookup(self.odom, self.camera, stamp) @ T_OPTICAL_BODY
        return self.tree.lookup(self.odom, str(self.laser), stamp)

    def T_base_camera(self, stamp: int) -> NDArray[np.float64]:
        """The depth camera's optical frame on the base, (4, 4), m."""
        if self.base is None:
            return np.array(T_BODY_OPTICAL)
        return self.tree.lookup(self.base, str(self.camera), stamp)

    def T_base_laser(self, stamp: int, scan_stamp: int) -> NDArray[np.float64]:
        """Where the laser was at `scan_stamp`, seen from the base at `stamp` (ns): (4, 4), m.

        The base moves between the two; odometry says how far.
        """
        laser = str(self.laser)
        if self.base is not None and stamp == scan_stamp:
            return self.tree.lookup(self.base, laser, stamp)
        if self.base is None:
            T_odom_laser = self.tree.lookup(self.odom, laser, scan_stamp)
        else:
            T_base_laser = self.tree.lookup(self.base, laser, scan_stamp)
            T_odom_laser = self.T_odom_base(scan_stamp) @ T_base_laser
        return inverse(self.T_odom_base(stamp)) @ T_odom_laser


def choose_frames(index: Index, options: BagOptions, path: Path) -> Frames:
    """Frames by option, by the odometry message, by tf's usual names; `SourceError` if no chain."""
    camera = index.depth.frame_id if len(index.depth) else None
    laser = index.scan.frame_id if len(index.scan) else None
    sensors = [s for s in (camera, laser) if s is not None]
    base = _base(index.tree, index.odometry, options, sensors[0])
    odom = _odom(index, options, base or sensors[0], path)
    for sensor in sensors:
        if not index.tree.connected(base or odom, sensor):
            raise SourceError(
                f"{path}: no tf leads from {base or odom!r} to the sensor frame {sensor!r}; record "
                "/tf_static, choose base_frame=, or leave the sensor out with depth_topic=none or "
                "scan_topic=none"
            )
    index.tree.keep_only([(odom, base or odom), *((base or odom, s) for s in sensors)])
    return Frames(index.tree, odom, base, camera, laser)


def _base(tree: FrameTree, odometry: Odometry, options: BagOptions, sensor: str) -> str | None:
    if options.base_frame is not None:
        return options.base_frame.lstrip("/")
    if len(odometry.track) and odometry.child in tree.frames:
        return odometry.child
    usual = next((b for b in _BASES if b in tree.frames and tree.connected(b, sensor)), None)
    return usual or (odometry.child if len(odometry.track) else "") or None


def _odom(index: Index, options: BagOptions, moving: str, path: Path) -> str:
    """The fixed frame in which `moving` has poses.

    tf comes before the odometry topic, for it is what the rest of a robot navigates by.
    """
    tree, odometry = index.tree, index.odometry
    asked = options.odom_frame.lstrip("/") if options.odom_frame else None
    if options.odom_topic is not None:
        return asked or _hang(tree, odometry, moving)
    fixed = asked or odometry.parent or _ODOM
    if tree.connected(fixed, moving) and tree.moves(fixed, moving):
        return fixed
    if len(odometry.track) and asked in (None, odometry.parent):
        return _hang(tree, odometry, moving)
    root = tree.root_of(moving)
    if asked is None and tree.moves(root, moving):
        return root
    raise SourceError(
        f"{path}: no poses for {moving!r}: neither nav_msgs/Odometry nor a moving tf from "
        f"{fixed!r}; record /odom or /tf, or choose odom_frame=, base_frame= or odom_topic="
    )


def _hang(tree: FrameTree, odometry: Odometry, moving: str) -> str:
    """Hang the odometry topic's child into the tree; a child that tf lacks is what moves."""
    child = odometry.child if odometry.child in tree.frames else moving
    parent = odometry.parent or _ODOM
    tree.replace_parent(parent, child, odometry.track)
    return parent
