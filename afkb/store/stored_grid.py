"""The occupancy grid of a map folder, read back from what nav2's map_server would read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb.flow import OccupancyGrid

SETTINGS = "occupancy.yaml"
UNKNOWN_GREY = 128
"""Grey of cells of which nothing is known; no known cell has it (docs/reference.md, The grid)."""


@dataclass(frozen=True, slots=True, eq=False)
class StoredGrid:
    """A grid with the thresholds that are stated beside it: free below, occupied above."""

    grid: OccupancyGrid
    free_below: float
    occupied_above: float


def read_grid(folder: Path) -> StoredGrid:
    """The grid of a map folder; raises `MapError` where it is missing or can't be read."""
    import yaml

    path = folder / SETTINGS
    try:
        stated = yaml.safe_load(path.read_text(encoding="utf-8"))
        grey = _pgm((folder / str(stated["image"])).read_bytes())
        resolution, origin = float(stated["resolution"]), stated["origin"]
        free, occupied = float(stated["free_thresh"]), float(stated["occupied_thresh"])
        x, y = float(origin[0]), float(origin[1])
        if not resolution > 0 or not 0 <= free <= occupied <= 1:
            raise ValueError(f"resolution {resolution}, thresholds {free} and {occupied}")
    except OSError as error:
        raise MapError(f"{path}: {error.strerror or error}; map again") from error
    except (ValueError, KeyError, TypeError, IndexError, yaml.YAMLError) as error:
        raise MapError(f"{path}: no grid that can be read ({error}); map again") from error
    bottom_up = np.ascontiguousarray(grey[::-1])
    probability = ((255 - bottom_up.astype(np.float32)) / 255).astype(np.float32)
    probability[bottom_up == UNKNOWN_GREY] = np.nan
    return StoredGrid(OccupancyGrid(probability, resolution, (x, y)), free, occupied)


def _pgm(content: bytes) -> NDArray[np.uint8]:
    """The pixels (rows, cols) of a binary PGM of 8 bits; `ValueError` for anything else."""
    kind, cols, rows, most = content.split(maxsplit=4)[:4]
    shape = int(rows), int(cols)
    # What splits the header may also be a pixel's value: only the last byte before it is taken.
    start = len(content) - shape[0] * shape[1]
    if kind != b"P5" or int(most) != 255 or start < 1:
        raise ValueError("the image is no binary PGM of 8 bits")
    return np.frombuffer(content, np.uint8, offset=start).reshape(shape)
