"""One pass over a bag: when each image and scan was taken, and all that is small."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection

from afkb.errors import BadFrame, SourceError
from afkb.flow import PinholeCamera
from afkb_mapping.recordings.pose_track import Track
from afkb_rosbag.options import BagOptions
from afkb_rosbag.recording import decoded, header_of, messages, stamp_ns
from afkb_rosbag.topics import TF_TYPES, Topics
from afkb_rosbag.transforms import FrameTree


class Moments:
    """When messages of one topic were taken and when they were recorded, ns; no message is held."""

    def __init__(self) -> None:
        self.frame_id = ""
        self._stamps = array("q")
        self._received = array("q")

    def __len__(self) -> int:
        return len(self._stamps)

    def add(self, stamp: int, received: int, frame_id: str) -> None:
        """Take note of one message."""
        self.frame_id = self.frame_id or frame_id
        self._stamps.append(stamp)
        self._received.append(received)

    def in_order(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Stamps in order, without repetitions, and when each was recorded first."""
        stamps = np.array(self._stamps, dtype=np.int64)
        unique, first = np.unique(stamps, return_index=True)
        return unique, np.array(self._received, dtype=np.int64)[first]


@dataclass
class Odometry:
    """The odometry topic as a track of `child` in `parent`."""

    parent: str = ""
    child: str = ""
    track: Track = field(default_factory=Track)


@dataclass
class Index:
    """What one pass leaves: moments, transforms, odometry, and the cameras in force by stamp."""

    depth: Moments
    scan: Moments
    tree: FrameTree
    odometry: Odometry
    cameras: list[tuple[int, PinholeCamera]]

    def camera_at(self, stamp: int) -> PinholeCamera:
        """The last intrinsics stated up to a stamp (ns), else the first."""
        before = [camera for at, camera in self.cameras if at <= stamp]
        return before[-1] if before else self.cameras[0][1]


def build_index(reader: AnyReader, path: Path, topics: Topics, options: BagOptions) -> Index:
    """Read the bag once; `SourceError` where its intrinsics are unusable."""
    tree = FrameTree(options.max_dt, options.max_gap)
    index = Index(Moments(), Moments(), tree, Odometry(), [])
    rectified = topics.depth is not None and "rect" in topics.depth
    takers = _takers(reader, path, topics, index, rectified)
    used = [c for c in reader.connections if c.topic in takers]
    for connection, received, raw in messages(reader, path, used):
        takers[connection.topic](connection, received, raw)
    return index


_Taker = Callable[[Connection, int, bytes], None]


def _takers(
    reader: AnyReader, path: Path, topics: Topics, index: Index, rectified: bool
) -> dict[str, _Taker]:
    """What to do with a message of each topic in use."""

    def moments(into: Moments) -> _Taker:
        def take(_: Connection, received: int, raw: bytes) -> None:
            header = header_of(raw, received, reader.is2)
            into.add(header.stamp, received, header.frame_id)

        return take

    def small(act: Callable[[Any, int], None]) -> _Taker:
        def take(connection: Connection, received: int, raw: bytes) -> None:
            act(decoded(reader, connection, raw), received)

        return take

    def tf(static: bool) -> Callable[[Any, int], None]:
        return lambda message, received: _take_tf(index.tree, message, received, static)

    def info(message: Any, received: int) -> None:
        _take_info(index.cameras, message, received, rectified, f"{path}: {topics.camera_info}")

    def odometry(message: Any, received: int) -> None:
        _take_odometry(index.odometry, message, received)

    takers = {
        c.topic: small(tf(c.topic.endswith("tf_static")))
        for c in _of_types(reader.connections, TF_TYPES)
    }
    takers |= {t: moments(index.depth) for t in (topics.depth,) if t}
    takers |= {t: moments(index.scan) for t in (topics.scan,) if t}
    takers |= {t: small(info) for t in (topics.camera_info,) if t}
    takers |= {t: small(odometry) for t in (topics.odom,) if t}
    return takers


def _of_types(connections: Sequence[Connection], types: Sequence[str]) -> list[Connection]:
    return [c for c in connections if c.msgtype in types]


def _take_tf(tree: FrameTree, message: Any, received: int, static: bool) -> None:
    for one in message.transforms:
        parent, child = one.header.frame_id.lstrip("/"), one.child_frame_id.lstrip("/")
        t, q = one.transform.translation, one.transform.rotation
        track = tree.track(parent, child, static)
        track.add(stamp_ns(one, received), (t.x, t.y, t.z), (q.x, q.y, q.z, q.w))


def _take_odometry(odometry: Odometry, message: Any, received: int) -> None:
    odometry.parent = odometry.parent or message.header.frame_id.lstrip("/")
    odometry.child = odometry.child or message.child_frame_id.lstrip("/")
    p, q = message.pose.pose.position, message.pose.pose.orientation
    odometry.track.add(stamp_ns(message, received), (p.x, p.y, p.z), (q.x, q.y, q.z, q.w))


def _take_info(
    cameras: list[tuple[int, PinholeCamera]], message: Any, received: int, rectified: bool, at: str
) -> None:
    """Keep a CameraInfo where it says something new."""
    try:
        camera = camera_of(message, rectified)
    except BadFrame as error:
        raise SourceError(f"{at}: {error}; calibrate the camera and record again") from error
    if not cameras or cameras[-1][1] != camera:
        cameras.append((stamp_ns(message, received), camera))


def camera_of(message: Any, rectified: bool) -> PinholeCamera:
    """Intrinsics of the image that a CameraInfo goes with: K, or P where it is rectified.

    Its numbers are of the full sensor; region of interest, then binning, lead to the image.
    """
    K = getattr(message, "k", None)
    P = getattr(message, "p", None)
    K = message.K if K is None else K  # ROS 1 writes them in capitals
    P = message.P if P is None else P
    fx, fy, cx, cy = (P[0], P[5], P[2], P[6]) if rectified and P[0] else (K[0], K[4], K[2], K[5])
    bin_x, bin_y, roi = message.binning_x or 1, message.binning_y or 1, message.roi
    return PinholeCamera(
        width=int(roi.width or message.width) // bin_x,
        height=int(roi.height or message.height) // bin_y,
        fx=float(fx) / bin_x,
        fy=float(fy) / bin_y,
        cx=(float(cx) - roi.x_offset) / bin_x,
        cy=(float(cy) - roi.y_offset) / bin_y,
    )
