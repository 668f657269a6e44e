"""Image files of a recording, refused as a `BadFrame` where they can't be believed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb_mapping.depth_png import decode_png16, metres, png_size

_IMAGES_ASKED_FOR_SIZE = 25


def read_depth(path: Path, per_metre: float) -> NDArray[np.float32]:
    """Depth (H, W) float32, m; `BadFrame` where the file is missing, damaged or not 16-bit."""
    try:
        return metres(decode_png16(path.read_bytes()), per_metre)
    except FileNotFoundError as error:
        raise BadFrame(f"no {path.name} for this pose") from error
    except OSError as error:
        raise BadFrame(f"{path.name}: {error.strerror}") from error
    except BadFrame as error:
        raise BadFrame(f"{path.name}: {error}") from error


def read_color(path: Path, size: tuple[int, ...]) -> NDArray[np.uint8]:
    """Colour (H, W, 3) uint8 RGB of the same size as depth, or `BadFrame`."""
    import cv2

    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise BadFrame(f"{path.name}: {error.strerror}") from error
    bgr = cv2.imdecode(data, cv2.IMREAD_COLOR) if len(data) else None
    if bgr is None or bgr.shape[:2] != size:
        got = "no image" if bgr is None else f"{bgr.shape[1]}x{bgr.shape[0]}"
        raise BadFrame(
            f"{path.name}: {got}, registered colour has depth's {size[1]}x{size[0]}; "
            "leave it out with the option color=none"
        )
    return np.asarray(cv2.cvtColor(bgr, cv2.COLOR_BGR2RGB), dtype=np.uint8)


def common_size(paths: Iterable[Path]) -> tuple[int, int] | None:
    """(width, height) that most of the first readable PNGs state in their headers."""
    sizes = (size for path in paths if (size := _stated_size(path)))
    counts = Counter(islice(sizes, _IMAGES_ASKED_FOR_SIZE))
    return counts.most_common(1)[0][0] if counts else None


def _stated_size(path: Path) -> tuple[int, int] | None:
    if not path.is_file():
        return None
    with path.open("rb") as file:
        return png_size(file.read(24))
