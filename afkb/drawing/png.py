"""A grid as a PNG inside a page: no file, no network."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_GREY_AND_ALPHA = 4


def png(pixels: NDArray[np.uint8]) -> bytes:
    """PNG of (rows, cols, 2) uint8 grey and alpha (RFC 2083)."""
    rows, columns = pixels.shape[:2]
    header = struct.pack(">IIBBBBB", columns, rows, 8, _GREY_AND_ALPHA, 0, 0, 0)
    unfiltered = np.zeros((rows, 1 + columns * 2), dtype=np.uint8)
    unfiltered[:, 1:] = pixels.reshape(rows, -1)
    parts = (
        (b"IHDR", header),
        (b"IDAT", zlib.compress(unfiltered.tobytes(), 9)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in parts)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def grid_image(probability: NDArray[np.float32]) -> str:
    """A data URI of an occupancy grid (rows along +y): occupied dark, unknown transparent."""
    known = np.isfinite(probability)
    p = np.clip(np.where(known, probability, 0.0), 0.0, 1.0)
    grey = np.round(255 * (1 - p)).astype(np.uint8)
    alpha = np.where(known, 255, 0).astype(np.uint8)
    image = np.stack([grey, alpha], axis=-1)[::-1]
    return "data:image/png;base64," + base64.b64encode(png(image)).decode()
