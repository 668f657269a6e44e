"""How steady rooms are: a plan drawn a little differently, and its rooms laid back on the plan.

A robot's second map of a home differs from its first by noise at walls, by a cell more or less of
each, by where the grid begins and how it is turned. Its rooms should not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from bench.mapping.room_scores import scores

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]
Array = NDArray[np.float64]
Segmenter = Callable[[Mask, float], Labels]

SALT = 0.02
"""Part of the cells at the rim of free space that are drawn the other way."""
SCALES = {"coarser by a tenth": 0.9, "finer by a tenth": 1.1}
TURN_RAD = math.radians(5.0)
SEED = 20


def steadiness(segmenter: Segmenter, free: Mask, resolution_m: float) -> dict[str, float]:
    """Matthews coefficient (Mielle et al. 2017) of rooms of each drawing with the plan's, 0 to 1.

    `free` (rows, cols): of the plan.
    """
    rooms = segmenter(free, resolution_m)
    return {
        name: scores(lay(segmenter(drawn, resolution)), rooms)["mcc"]
        for name, drawn, resolution, lay in drawings(free, resolution_m)
    }


def drawings(
    free: Mask, resolution_m: float
) -> Iterator[tuple[str, Mask, float, Callable[[Labels], Labels]]]:
    """Name, free cells, and size of a cell (m) of each; and how its labels are laid on the plan."""
    yield "salt at the rim", _salted(free), resolution_m, lambda labels: labels
    yield "walls a cell thicker", ndimage.binary_erosion(free), resolution_m, lambda labels: labels
    for name, scale in SCALES.items():
        drawn, lay = _redrawn(free, scale, 0.0)
        yield name, drawn, resolution_m / scale, lay
    for name, turn in (("turned left", TURN_RAD), ("turned right", -TURN_RAD)):
        drawn, lay = _redrawn(free, 1.0, turn)
        yield name, drawn, resolution_m, lay


def _salted(free: Mask) -> Mask:
    rim = ndimage.binary_dilation(free) & ~ndimage.binary_erosion(free)
    return free ^ (rim & (np.random.default_rng(SEED).random(free.shape) < SALT))


def _redrawn(free: Mask, scale: float, turn: float) -> tuple[Mask, Callable[[Labels], Labels]]:
    """The plan scaled and turned about its middle, and how labels (rows, cols) are laid back."""
    import cv2

    rows, cols = free.shape
    middle = np.array([cols, rows]) / 2
    c, s = scale * math.cos(turn), scale * math.sin(turn)
    size = np.ceil([abs(c) * cols + abs(s) * rows, abs(s) * cols + abs(c) * rows]).astype(int)
    rotation = np.array([[c, -s], [s, c]])
    moved = np.column_stack([rotation, size / 2 - rotation @ middle])
    drawn = cv2.warpAffine(
        free.astype(np.uint8) * 255, moved, size.tolist(), flags=cv2.INTER_LINEAR
    )

    def lay(labels: Labels) -> Labels:
        flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
        laid = cv2.warpAffine(labels.astype(np.float32), moved, (cols, rows), flags=flags)
        return laid.astype(np.int32)

    return drawn >= 128, lay
