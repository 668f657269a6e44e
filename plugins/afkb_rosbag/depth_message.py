"""Depth out of `sensor_msgs/Image` and `CompressedImage`, in metres."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb_mapping.depth_png import SIGNATURE, decode_png16, metres

RAW_ENCODINGS = ("16UC1", "mono16", "32FC1")
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED = "sensor_msgs/msg/CompressedImage"
# compressed_depth_image_transport: int32 format, float32 quantisation A and B, then the PNG.
_CONFIG = struct.Struct("<iff")


def is_depth(message: Any) -> bool:
    """Whether an image message holds depth, by what it says of itself."""
    if message.__msgtype__ == IMAGE:
        return message.encoding in RAW_ENCODINGS
    stated = message.format
    return "compressedDepth" in stated or stated.split(";")[0].strip() in ("16UC1", "32FC1")


def depth_of(message: Any) -> NDArray[np.float32]:
    """Depth (H, W) float32 m, 0 where nothing came back; `BadFrame` where it cannot be read."""
    if message.__msgtype__ == IMAGE:
        return _from_image(message)
    return _from_compressed(bytes(message.data), message.format)


def _from_image(message: Any) -> NDArray[np.float32]:
    if message.encoding not in RAW_ENCODINGS:
        raise BadFrame(f"encoding {message.encoding!r}, depth is one of {', '.join(RAW_ENCODINGS)}")
    kind = "f4" if message.encoding == "32FC1" else "u2"
    dtype = np.dtype((">" if message.is_bigendian else "<") + kind)
    height, width, step = message.height, message.width, message.step
    data = np.asarray(message.data, dtype=np.uint8)
    if step < width * dtype.itemsize or data.size < height * step:
        raise BadFrame(f"image of {width}x{height}, {step} bytes a row, holds {data.size} bytes")
    rows = data[: height * step].reshape(height, step)[:, : width * dtype.itemsize]
    pixels = np.ascontiguousarray(rows).view(dtype)
    return _finite(pixels.astype(np.float32)) if kind == "f4" else metres(pixels.astype(np.uint16))


def _from_compressed(data: bytes, stated: str) -> NDArray[np.float32]:
    """`compressedDepth`, or a plain 16-bit PNG as `compressed` writes of 16UC1.

    Float depth is stored as A / depth + B in 16 bits, rounded (compressed_depth_image_transport).
    """
    if data.startswith(SIGNATURE):
        return metres(decode_png16(data))
    if len(data) < _CONFIG.size:
        raise BadFrame(f"compressedDepth of {len(data)} bytes is cut short")
    _, quant_a, quant_b = _CONFIG.unpack_from(data)
    if not data.startswith(SIGNATURE, _CONFIG.size):
        raise BadFrame(
            f"compressedDepth ({stated!r}) holds no PNG behind its header; republish RVL as PNG"
        )
    pixels = decode_png16(memoryview(data)[_CONFIG.size :])
    if not stated.startswith("32FC1"):
        return metres(pixels)
    with np.errstate(divide="ignore", invalid="ignore"):
        depth_m = np.float32(quant_a) / (pixels.astype(np.float32) - np.float32(quant_b))
    depth_m[pixels == 0] = 0
    return _finite(depth_m)


def _finite(depth_m: NDArray[np.float32]) -> NDArray[np.float32]:
    with np.errstate(invalid="ignore"):
        depth_m[~(np.isfinite(depth_m) & (depth_m > 0))] = 0
    return depth_m
