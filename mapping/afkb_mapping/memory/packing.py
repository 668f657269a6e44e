"""One remembered view as compressed bytes, and back: a few kilobytes, without pickled objects."""

from __future__ import annotations

import json
import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb.flow import LaserScan, PinholeCamera, View
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.said import (
    detection_json,
    detections_of,
    hypothesis_json,
    hypothesis_of,
    points_of,
)
from afkb_mapping.memory.thinning import metres, millimetres, ranges_of

LEVEL = 3
"""Of compression: higher ones take three times as long for a tenth less."""
HEAD = struct.Struct("<4I")
"""Bytes of the text, of the depth image, of the scan, and of the footprints that follow it."""

Json = dict[str, Any]


def packed(remembered: RememberedView) -> bytes:
    """The bytes of a remembered view; the same for the same view."""
    view = remembered.view
    text: Json = {
        "index": view.index,
        "stamp": view.stamp,
        "odom": _matrix(view.T_odom_base),
        "map": _matrix(view.T_map_base),
        "base": view.has_base,
        "T_camera": _matrix(view.T_base_camera),
        "T_laser": _matrix(view.T_base_laser),
        "detections": [detection_json(d) for d in remembered.detections],
        "hypotheses": [hypothesis_json(h) for h in remembered.hypotheses],
    }
    depth, ranges = np.zeros((0, 0), np.uint16), np.zeros(0, np.uint16)
    if view.depth_m is not None and view.camera is not None:
        depth, c = millimetres(view.depth_m), view.camera
        text["camera"] = [c.width, c.height, c.fx, c.fy, c.cx, c.cy]
    if view.scan is not None:
        ranges, s = millimetres(view.scan.ranges_m), view.scan
        text["scan"] = [s.angle_min, s.angle_increment, s.range_min_m, s.range_max_m]
    parts = (
        json.dumps(text, separators=(",", ":"), ensure_ascii=False).encode(),
        _bytes_of(np.diff(depth, axis=1, prepend=np.uint16(0)).astype(np.uint16)),
        _bytes_of(ranges),
        _bytes_of(points_of(remembered.detections)),
    )
    return zlib.compress(HEAD.pack(*map(len, parts)) + b"".join(parts), LEVEL)


def unpacked(content: bytes) -> RememberedView:
    """The inverse of `packed`. Raises `MapError` where the bytes are none of its."""
    try:
        whole = zlib.decompress(content)
        parts, at = [], HEAD.size
        for length in HEAD.unpack_from(whole):
            parts.append(whole[at : at + length])
            at += length
        text = json.loads(parts[0])
        steps = _array_of(parts[3], np.dtype(np.int32)).reshape(-1, 2)
        return RememberedView(
            _view(text, *(_array_of(part, np.dtype(np.uint16)) for part in parts[1:3])),
            detections_of(text["detections"], steps),
            tuple(hypothesis_of(told) for told in text["hypotheses"]),
        )
    except (zlib.error, struct.error, ValueError, KeyError, TypeError) as error:
        raise MapError(f"a remembered view can't be read ({error}); map again") from error


def _view(text: Json, steps: NDArray[np.uint16], ranges: NDArray[np.uint16]) -> View:
    camera = scan = depth_m = None
    if "camera" in text:
        camera = PinholeCamera(*text["camera"])
        steps = steps.reshape(camera.height, camera.width)
        depth_m = metres(np.cumsum(steps, axis=1, dtype=np.uint16))
    if "scan" in text:
        scan = LaserScan(ranges_of(ranges), *text["scan"])
    T_odom_base = _transform(text["odom"])
    assert T_odom_base is not None
    return View(
        index=text["index"],
        stamp=text["stamp"],
        T_odom_base=T_odom_base,
        depth_m=depth_m,
        camera=camera,
        T_base_camera=_transform(text["T_camera"]),
        scan=scan,
        T_base_laser=_transform(text["T_laser"]),
        has_base=text["base"],
        T_map_base=_transform(text["map"]),
    )


def _bytes_of(values: NDArray[Any]) -> bytes:
    """Low bytes, then the next ones …: those of one place are alike, which compresses well."""
    little = values.astype(values.dtype.newbyteorder("<"))
    return little.reshape(-1, 1).view(np.uint8).T.tobytes()


def _array_of(content: bytes, dtype: np.dtype[Any]) -> NDArray[Any]:
    planes = np.frombuffer(content, np.uint8).reshape(dtype.itemsize, -1)
    return np.ascontiguousarray(planes.T).view(dtype.newbyteorder("<")).ravel().astype(dtype)


def _matrix(T: NDArray[np.float64] | None) -> list[float] | None:
    return None if T is None else T.ravel().tolist()


def _transform(values: list[float] | None) -> NDArray[np.float64] | None:
    return None if values is None else np.array(values, np.float64).reshape(4, 4)
