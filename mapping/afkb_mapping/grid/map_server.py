"""The occupancy grid as a PGM image and a YAML file, as nav2's map_server loads them.

In `mode: scale` map_server takes p = (255 - pixel) / 255, calls a cell free (0) where
p < free_thresh and occupied (100) where p > occupied_thresh, and stretches what is between over
0..100; predicted things thus keep their probability. Only an alpha channel could say "unknown"
in that mode and a PGM has none, so unknown cells get the grey of p = 0.5, which no known cell
has: `mode: trinary` reads it as unknown (-1), and so does whoever looks for that grey. (The usual
205 would read as free in `scale`: it lies at the free threshold.)
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid

IMAGE = "occupancy.pgm"
SETTINGS = "occupancy.yaml"
UNKNOWN = 128
OCCUPIED_THRESHOLD = 0.65
FREE_THRESHOLD = 0.196


def pixels(grid: OccupancyGrid) -> NDArray[np.uint8]:
    """(rows, cols) uint8, the top row at the largest y: 0 occupied, 255 free, 128 unknown.

    A predicted thing at the least start value, 0.65 (paper §II.E), is just above the threshold:
    rounding goes towards occupied, so that a planner keeps clear of it.
    """
    if grid.probability.size == 0:
        return np.full((1, 1), UNKNOWN, dtype=np.uint8)
    known = np.isfinite(grid.probability)
    p = np.clip(np.where(known, grid.probability, 0.5), 0.0, 1.0).astype(np.float64)
    grey = np.floor(255.0 * (1.0 - p) + 1e-4).astype(np.uint8)
    grey[grey == UNKNOWN] = UNKNOWN - 1
    grey[~known] = UNKNOWN
    return np.ascontiguousarray(grey[::-1])


def settings(grid: OccupancyGrid) -> str:
    """The YAML that map_server reads beside the image."""
    x, y = (round(float(v), 6) + 0.0 for v in grid.origin_xy)
    return (
        f"image: {IMAGE}\n"
        "mode: scale\n"
        f"resolution: {round(float(grid.resolution_m), 6)}\n"
        f"origin: [{x}, {y}, 0.0]\n"
        "negate: 0\n"
        f"occupied_thresh: {OCCUPIED_THRESHOLD}\n"
        f"free_thresh: {FREE_THRESHOLD}\n"
        f"# Unknown cells have grey {UNKNOWN}; with mode: trinary they load as unknown.\n"
    )


def write_grid(grid: OccupancyGrid, folder: Path) -> tuple[Path, Path]:
    """Write image and settings into a folder; return both files."""
    image = pixels(grid)
    rows, columns = image.shape
    written = (folder / IMAGE, folder / SETTINGS)
    written[0].write_bytes(f"P5\n{columns} {rows}\n255\n".encode() + image.tobytes())
    written[1].write_text(settings(grid), encoding="utf-8")
    return written
