"""16-bit depth PNGs, checked before they are believed: decoders fill in what is missing."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame

SIGNATURE = b"\x89PNG\r\n\x1a\n"
_NO_RETURN = 65535


def png_size(head: bytes) -> tuple[int, int] | None:
    """(width, height) that the first 24 bytes of a PNG state, or None if they are no PNG."""
    if len(head) < 24 or not head.startswith(SIGNATURE) or head[12:16] != b"IHDR":
        return None
    width, height = struct.unpack(">II", head[16:24])
    return (width, height) if width and height else None


def decode_png16(data: bytes | memoryview) -> NDArray[np.uint16]:
    """(H, W) uint16 pixels of a one-channel 16-bit PNG.

    Raises `BadFrame` where the file is cut short or damaged (OpenCV would hand back an image
    with the rest black), or is not 16-bit grey.
    """
    import cv2

    check_complete(data)
    pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    if pixels is None:
        raise BadFrame("PNG does not decode")
    if pixels.ndim != 2:
        raise BadFrame(f"PNG has {pixels.shape[2]} channels, depth has one")
    if pixels.dtype != np.uint16:
        raise BadFrame(f"PNG has {8 * pixels.itemsize} bits a pixel, depth needs 16")
    return np.asarray(pixels, dtype=np.uint16)


def metres(pixels: NDArray[np.uint16], per_metre: float = 1000.0) -> NDArray[np.float32]:
    """Depth (H, W) float32 m of raw pixels; 0 and 65535, both 'no return', become 0."""
    depth_m = np.divide(pixels, np.float32(per_metre), dtype=np.float32)
    depth_m[pixels == _NO_RETURN] = 0.0
    return depth_m


def check_complete(data: bytes | memoryview) -> None:
    """Raise `BadFrame` unless every chunk of a PNG is there, undamaged, up to its end mark."""
    view = memoryview(data)
    if bytes(view[:8]) != SIGNATURE:
        raise BadFrame("not a PNG")
    at = 8
    while True:
        if at + 12 > len(view):
            raise BadFrame(f"PNG is cut short after {len(view)} bytes")
        (length,) = struct.unpack_from(">I", view, at)
        end = at + 12 + length
        if end > len(view):
            raise BadFrame(f"PNG is cut short after {len(view)} bytes")
        (stated,) = struct.unpack_from(">I", view, end - 4)
        if zlib.crc32(view[at + 4 : end - 4]) != stated:
            raise BadFrame(f"PNG is damaged at byte {at}: checksum differs")
        if bytes(view[at + 4 : at + 8]) == b"IEND":
            return
        at = end
