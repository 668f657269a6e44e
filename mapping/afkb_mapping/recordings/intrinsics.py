"""Camera intrinsics of a folder: from an option, or a 3x3 matrix in a text file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from afkb.errors import BadFrame, SourceError
from afkb.flow import PinholeCamera

_NAMES = ("camera-intrinsics.txt", "intrinsics.txt", "camera_intrinsics.txt")
_MEND = "write the 3x3 matrix `fx 0 cx / 0 fy cy / 0 0 1` (pixels) in it, a row a line"


def find_intrinsics(
    folder: Path, given: tuple[float, float, float, float] | None, size: tuple[int, int]
) -> PinholeCamera:
    """The depth camera; `given` is (fx, fy, cx, cy), `size` (width, height), pixels.

    The file may also lie one folder up, where 3DMatch puts it for all sequences of a scene.
    Raises `SourceError` where there is none, or it holds no usable matrix.
    """
    if given is not None:
        return camera_of("option intrinsics", "give it as intrinsics=fx,fy,cx,cy", given, size)
    path = intrinsics_file(folder)
    if path is None:
        raise SourceError(
            f"{folder / _NAMES[0]}: no intrinsics; {_MEND}, "
            "or give the option intrinsics=fx,fy,cx,cy"
        )
    return camera_of(str(path), _MEND, _read(path), size)


def intrinsics_file(folder: Path) -> Path | None:
    """The text file that holds the matrix, in the folder or one up; None where there is none."""
    places = (folder, folder.resolve().parent)
    return next((p / name for p in places for name in _NAMES if (p / name).is_file()), None)


def _read(path: Path) -> tuple[float, float, float, float]:
    try:
        numbers = [float(word) for word in path.read_text().replace(",", " ").split()]
    except (ValueError, OSError) as error:
        raise SourceError(f"{path}: intrinsics are not numbers ({error}); {_MEND}") from error
    if len(numbers) == 9:
        K = np.array(numbers).reshape(3, 3)
    elif len(numbers) == 16:  # ScanNet writes the matrix with a fourth row and column
        K = np.array(numbers).reshape(4, 4)[:3, :3]
    else:
        raise SourceError(f"{path}: {len(numbers)} numbers, expected 9; {_MEND}")
    return float(K[0, 0]), float(K[1, 1]), float(K[0, 2]), float(K[1, 2])


def camera_of(
    where: str, mend: str, values: tuple[float, float, float, float], size: tuple[int, int]
) -> PinholeCamera:
    """The camera of these values (fx, fy, cx, cy); `SourceError` says where and the mend."""
    width, height = size
    fx, fy, cx, cy = values
    try:
        camera = PinholeCamera(width, height, fx, fy, cx, cy)
    except BadFrame as error:
        raise SourceError(f"{where}: {error}; {mend}") from error
    if not (0 < cx < width and 0 < cy < height):
        raise SourceError(
            f"{where}: principal point ({cx:g}, {cy:g}) lies outside the {width}x{height} depth "
            f"image, so it is another camera's; {mend}"
        )
    return camera
