"""Small bags written by `rosbags`' own writers: code that the source under test did not write."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from afkb.flow import View
from afkb.plugins.protocols import Source
from afkb_rosbag import afkb_open_source

NS = 1_000_000_000
WIDTH, HEIGHT = 40, 30
CAMERA_FRAME = "camera_optical"
DEPTH, INFO = "/camera/depth/image_raw", "/camera/depth/camera_info"
# x right, y down, z ahead, seen from a base with x ahead and z up.
OPTICAL_XYZW = (-0.5, 0.5, -0.5, 0.5)


def wall(distance_m: float = 2.0) -> NDArray[np.float32]:
    """Depth (H, W) m of a slanted wall, with a corner from which nothing comes back."""
    depth_m = np.full((HEIGHT, WIDTH), distance_m, np.float32)
    depth_m += np.linspace(0, 0.5, WIDTH, dtype=np.float32)
    depth_m[:5, :5] = 0
    return depth_m


def millimetres(depth_m: NDArray[np.float32]) -> NDArray[np.uint16]:
    return np.round(depth_m * 1000).astype(np.uint16)


def png(pixels: NDArray[Any]) -> bytes:
    return cv2.imencode(".png", pixels)[1].tobytes()


@cache
def typestore(ros1: bool) -> Any:
    """Message types of a ROS; ROS 1's lack tf's."""
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    if ros1:
        for name in ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"):
            store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", name))
    return store


@dataclass
class BagWriter:
    """Collects messages, then writes them in order of time of recording."""

    ros1: bool = False
    tf_type: str = "tf2_msgs/msg/TFMessage"
    messages: list[tuple[int, str, str, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.store = typestore(self.ros1)

    def new(self, name: str, **fields: Any) -> Any:
        return self.store.types[name](**fields)

    def header(self, seconds: float, frame: str) -> Any:
        stamp = round(seconds * NS)
        time = self.new("builtin_interfaces/msg/Time", sec=stamp // NS, nanosec=stamp % NS)
        extra = {"seq": 0} if self.ros1 else {}
        return self.new("std_msgs/msg/Header", stamp=time, frame_id=frame, **extra)

    def put(self, topic: str, message: Any, seconds: float) -> None:
        self.messages.append((round(seconds * NS), topic, message.__msgtype__, message))

    def image(self, t: float, depth: NDArray[Any], encoding: str, topic: str = DEPTH) -> None:
        height, width = depth.shape[:2]
        message = self.new(
            "sensor_msgs/msg/Image", header=self.header(t, CAMERA_FRAME), height=height,
            width=width, encoding=encoding, is_bigendian=int(depth.dtype.byteorder == ">"),
            step=depth[0].nbytes, data=np.frombuffer(depth.tobytes(), np.uint8),
        )  # fmt: skip
        self.put(topic, message, t)

    def compressed(self, t: float, data: bytes, stated: str = "16UC1; compressedDepth") -> None:
        message = self.new(
            "sensor_msgs/msg/CompressedImage", header=self.header(t, CAMERA_FRAME), format=stated,
            data=np.frombuffer(data, np.uint8),
        )  # fmt: skip
        self.put(f"{DEPTH}/compressedDepth", message, t)

    def camera_info(
        self, t: float, f: float = 40.0, topic: str = INFO, size: tuple[int, int] = (WIDTH, HEIGHT)
    ) -> None:
        width, height = size
        K = np.array([f, 0, width / 2, 0, f, height / 2, 0, 0, 1], np.float64)
        P = np.array([f, 0, width / 2, 0, 0, f, height / 2, 0, 0, 0, 1, 0], np.float64)
        D, R = np.zeros(5), np.eye(3).ravel()
        names = "DKRP" if self.ros1 else "dkrp"
        region = self.new("sensor_msgs/msg/RegionOfInterest", x_offset=0, y_offset=0, height=0,
                          width=0, do_rectify=False)  # fmt: skip
        message = self.new(
            "sensor_msgs/msg/CameraInfo", header=self.header(t, CAMERA_FRAME), height=height,
            width=width, distortion_model="plumb_bob", binning_x=0, binning_y=0, roi=region,
            **dict(zip(names, (D, K, R, P), strict=True)),
        )  # fmt: skip
        self.put(topic, message, t)

    def scan(self, t: float, beams: int = 8, topic: str = "/scan", delay: float = 0.0) -> None:
        message = self.new(
            "sensor_msgs/msg/LaserScan", header=self.header(t, "laser"), angle_min=-3.0,
            angle_max=3.0, angle_increment=0.75, time_increment=0.0, scan_time=0.1, range_min=0.1,
            range_max=10.0, ranges=np.full(beams, 2.0, np.float32),
            intensities=np.zeros(0, np.float32),
        )  # fmt: skip
        self.put(topic, message, t + delay)

    def _pose(self, x: float, yaw: float) -> tuple[Any, Any]:
        q = self.new("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=np.sin(yaw / 2),
                     w=np.cos(yaw / 2))  # fmt: skip
        return (x, 0.0, 0.0), q

    def odometry(self, t: float, x: float, yaw: float = 0.0, child: str = "base_link") -> None:
        xyz, q = self._pose(x, yaw)
        point = self.new("geometry_msgs/msg/Point", x=xyz[0], y=xyz[1], z=xyz[2])
        pose = self.new("geometry_msgs/msg/Pose", position=point, orientation=q)
        zero = self.new("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        twist = self.new("geometry_msgs/msg/Twist", linear=zero, angular=zero)
        message = self.new(
            "nav_msgs/msg/Odometry", header=self.header(t, "odom"), child_frame_id=child,
            pose=self.new("geometry_msgs/msg/PoseWithCovariance", pose=pose,
                          covariance=np.zeros(36)),
            twist=self.new("geometry_msgs/msg/TwistWithCovariance", twist=twist,
                           covariance=np.zeros(36)),
        )  # fmt: skip
        self.put("/odom", message, t)

    def tf(
        self, t: float, parent: str, child: str, xyz: tuple[float, float, float] = (0, 0, 0),
        xyzw: tuple[float, float, float, float] = (0, 0, 0, 1), static: bool = False,
    ) -> None:  # fmt: skip
        x, y, z = map(float, xyz)
        qx, qy, qz, qw = map(float, xyzw)
        transform = self.new(
            "geometry_msgs/msg/Transform",
            translation=self.new("geometry_msgs/msg/Vector3", x=x, y=y, z=z),
            rotation=self.new("geometry_msgs/msg/Quaternion", x=qx, y=qy, z=qz, w=qw),
        )
        one = self.new("geometry_msgs/msg/TransformStamped", header=self.header(t, parent),
                       child_frame_id=child, transform=transform)  # fmt: skip
        message = self.new(self.tf_type, transforms=[one])
        self.put("/tf_static" if static else "/tf", message, t)

    def write(self, path: Path, storage: str = "mcap") -> Path:
        """The bag's path: a folder for ROS 2, a file for ROS 1."""
        self.messages.sort(key=lambda m: m[0])
        if self.ros1:
            with Writer1(path) as bag1:
                self._write(bag1, self.store.serialize_ros1)
            return path
        plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
        with Writer2(path, version=9, storage_plugin=plugin) as bag2:
            self._write(bag2, self.store.serialize_cdr)
        return path

    def _write(self, bag: Any, serialize: Callable[[Any, str], Any]) -> None:
        connections: dict[str, Any] = {}
        for at, topic, kind, message in self.messages:
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, kind, typestore=self.store)
            bag.write(connections[topic], at, serialize(message, kind))


def robot(
    bag: BagWriter, frames: int = 6, depth: str | None = "16UC1", *, info: bool = True,
    scan: bool = True, odom: bool = True, tf: bool = True, statics: bool = True,
) -> BagWriter:  # fmt: skip
    """A robot that drives 0.1 m ahead every 0.2 s; depth frame k is a wall at 2 + k/10 m."""
    if statics:
        bag.tf(1.0, "base_link", "mast", (0, 0, 1.0), static=True)
        bag.tf(1.0, "mast", CAMERA_FRAME, (0.1, 0, 0), OPTICAL_XYZW, static=True)
        bag.tf(1.0, "base_link", "laser", (0.2, 0, 0.3), static=True)
    for k in range(frames):
        t = 1.0 + 0.2 * k
        if depth:
            put_depth(bag, t, wall(2 + 0.1 * k), depth)
        if depth and info:
            bag.camera_info(t)
        if scan:
            bag.scan(t)
        if odom:
            bag.odometry(t, 0.1 * k)
        if tf:
            bag.tf(t, "odom", "base_link", (0.1 * k, 0, 0))
    return bag


def put_depth(bag: BagWriter, t: float, depth_m: NDArray[np.float32], kind: str) -> None:
    """One depth image, in any of the forms in which ROS knows it."""
    if kind == "16UC1":
        bag.image(t, millimetres(depth_m), "16UC1")
    elif kind == "32FC1":
        bag.image(t, np.where(depth_m > 0, depth_m, np.float32("nan")), "32FC1")
    elif kind == "compressed16":
        bag.compressed(t, b"\0" * 12 + png(millimetres(depth_m)))
    else:
        bag.compressed(t, quantised(depth_m), "32FC1; compressedDepth")


def quantised(depth_m: NDArray[np.float32], depth_max: float = 10.0, quant: float = 100.0) -> bytes:
    """Float depth as compressed_depth_image_transport's codec writes it: A / depth + B."""
    a = quant * (quant + 1)
    b = 1.0 - a / depth_max
    with np.errstate(divide="ignore"):
        inverse = np.where(depth_m > 0, a / depth_m + b, 0)
    return struct.pack("<iff", 0, a, b) + png(inverse.astype(np.uint16))


def open_bag(path: Path, **options: str) -> Source:
    source = afkb_open_source(str(path), options, None)  # type: ignore[arg-type]
    assert source is not None
    return source


def all_views(source: Source) -> list[View]:
    frames = list(source.views())
    assert all(isinstance(f, View) for f in frames), frames
    return [f for f in frames if isinstance(f, View)]
