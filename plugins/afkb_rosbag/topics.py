"""Which topics of a bag to use: found by message type, or chosen by option."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection

from afkb.errors import BadFrame, SourceError
from afkb_rosbag.depth_message import COMPRESSED, IMAGE, is_depth
from afkb_rosbag.options import NONE, BagOptions
from afkb_rosbag.recording import decoded, messages

_CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
_SCAN = "sensor_msgs/msg/LaserScan"
_ODOMETRY = "nav_msgs/msg/Odometry"
TF_TYPES = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
_JUDGED = 10
_TRANSPORTS = ("/compressedDepth", "/compressed")


@dataclass(frozen=True, slots=True)
class Topics:
    """The topics in use; None where the recording lacks the sensor or it is left out."""

    depth: str | None
    camera_info: str | None
    scan: str | None
    odom: str | None


def choose_topics(reader: AnyReader, path: Path, options: BagOptions) -> Topics:
    """Topics by type and option; `SourceError` where there is nothing to map from."""
    depth = _depth(reader, path, options)
    scan = _one(reader, path, "scan_topic", options.scan_topic, (_SCAN,))
    if depth is None and scan is None:
        raise SourceError(
            f"{path}: no depth image and no laser scan among its topics: "
            f"{_listed(reader.connections)}; record one, or choose depth_topic= or scan_topic="
        )
    info = None if depth is None else _camera_info(reader, path, options, depth)
    odom = _one(reader, path, "odom_topic", options.odom_topic, (_ODOMETRY,))
    return Topics(depth, info, scan, odom)


def _one(
    reader: AnyReader, path: Path, option: str, chosen: str | None, types: tuple[str, ...]
) -> str | None:
    """The chosen topic, else the one of these types with most messages, the first by name."""
    if chosen == NONE:
        return None
    found = [c for c in reader.connections if c.msgtype in types and c.msgcount]
    if chosen is not None:
        _must_be_among(path, option, chosen, found)
        return chosen
    return min(found, key=lambda c: (-c.msgcount, c.topic)).topic if found else None


def _depth(reader: AnyReader, path: Path, options: BagOptions) -> str | None:
    """The depth topic: one named `…depth…` before others, raw before compressed."""
    if options.depth_topic == NONE:
        return None
    images = [c for c in reader.connections if c.msgtype in (IMAGE, COMPRESSED) and c.msgcount]
    if options.depth_topic is not None:
        _must_be_among(path, "depth_topic", options.depth_topic, images)
        return options.depth_topic
    found = [c for c in images if _holds_depth(reader, path, c)]

    def rank(c: Connection) -> tuple[bool, int, bool, str]:
        return ("depth" not in c.topic.lower(), -c.msgcount, c.msgtype != IMAGE, c.topic)

    return min(found, key=rank).topic if found else None


def _holds_depth(reader: AnyReader, path: Path, connection: Connection) -> bool:
    """Judged by its first sound message: colour and infrared come in the same type."""
    infrared = any(part.startswith("ir") or "infra" in part for part in connection.topic.split("/"))
    if infrared and "depth" not in connection.topic:
        return False
    for _, _, raw in islice(messages(reader, path, [connection]), _JUDGED):
        try:
            return is_depth(decoded(reader, connection, raw))
        except BadFrame:  # judge by the next; the frame is reported when it is read
            continue
    return False


def _camera_info(reader: AnyReader, path: Path, options: BagOptions, depth: str) -> str:
    """The CameraInfo beside the depth image, as image_transport lays them out."""
    found = [c for c in reader.connections if c.msgtype == _CAMERA_INFO and c.msgcount]
    if options.camera_info_topic is not None:
        _must_be_among(path, "camera_info_topic", options.camera_info_topic, found)
        return options.camera_info_topic
    expected = camera_info_beside(depth)
    if any(c.topic == expected for c in found):
        return expected
    raise SourceError(
        f"{path}: no CameraInfo for {depth}: expected {expected}, found {_listed(found)}; record "
        "it, choose one with camera_info_topic=, or leave depth out with depth_topic=none"
    )


def camera_info_beside(depth_topic: str) -> str:
    """`/camera/depth/camera_info` for `/camera/depth/image_raw/compressedDepth` and the like."""
    image = depth_topic
    for transport in _TRANSPORTS:
        image = image.removesuffix(transport)
    return image.rsplit("/", 1)[0] + "/camera_info"


def _must_be_among(path: Path, option: str, chosen: str, found: Sequence[Connection]) -> None:
    if all(c.topic != chosen for c in found):
        raise SourceError(f"{path}: {option}={chosen}: no such topic; there is {_listed(found)}")


def _listed(connections: Sequence[Connection]) -> str:
    return ", ".join(sorted({f"{c.topic} ({c.msgtype})" for c in connections})) or "none"
