"""Organised clouds of table-tops, labelled point by point (OSD, Richtsfeld et al., IROS 2012)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import PinholeCamera, View
from afkb_mapping.placing.levelling import level

TABLE_M = 0.74
"""Height at which a table is put whose floor isn't seen: that of most desks."""
GROUPS = ((16, "box"), (25, "stacked"), (32, "occluded"), (41, "cylindric"))
"""Last number of the clouds of a kind, as the set numbers them; what follows is mixed."""
WIDTH, HEIGHT = 640, 480
# The optical frame of a camera that looks along x, its image's up along z.
OPTICAL = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


@dataclass(frozen=True, eq=False)
class Cloud:
    """A cloud as a placed view, and the object of each pixel: 0 none, 1 the table, 2 and up."""

    name: str
    group: str
    view: View
    objects: NDArray[np.int32]

    @property
    def things(self) -> list[int]:
        """The objects that stand on the table."""
        return [int(k) for k in np.unique(self.objects) if k > 1]


def clouds_in(folder: Path) -> Iterator[Cloud]:
    """The clouds of a folder by their numbers. `SourceError` for one of another kind."""
    for path in sorted(folder.glob("*.pcd"), key=lambda p: (_number(p), p.name)):
        yield _cloud(path)


def _number(path: Path) -> int:
    digits = re.search(r"\d+", path.stem)
    return int(digits.group()) if digits else 0


def _cloud(path: Path) -> Cloud:
    import open3d

    cloud = open3d.t.io.read_point_cloud(str(path))
    if "label" not in cloud.point or len(cloud.point.positions) != WIDTH * HEIGHT:
        raise SourceError(f"{path}: not an organised {WIDTH}x{HEIGHT} cloud with labels")
    points = cloud.point.positions.numpy().reshape(HEIGHT, WIDTH, 3).astype(np.float64)
    labels = cloud.point["label"].numpy().reshape(HEIGHT, WIDTH).astype(np.int32)
    colours = None
    if "colors" in cloud.point:
        colours = np.ascontiguousarray(
            cloud.point.colors.numpy().reshape(HEIGHT, WIDTH, -1)[..., :3]
        )
    objects = np.where(labels == 0, 0, np.maximum(labels // 10, 1)).astype(np.int32)
    group = next((g for last, g in GROUPS if _number(path) <= last), "mixed")
    view = _placed(points, colours, objects == 1, _number(path))
    return Cloud(path.stem, group, view, objects)


def _placed(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8] | None,
    table: NDArray[np.bool_],
    index: int,
) -> View:
    """The view that such points (H, W, 3), optical frame, are of, level, its `table` at TABLE_M."""
    z = points[..., 2]
    depth = np.where(np.isfinite(z) & (z > 0), z, 0.0).astype(np.float32)
    view = View(index, 0.0, np.eye(4), depth, _camera(points), OPTICAL, color=colours)
    T_map_base = level([view], gravity_aligned=False).T_map_source
    T = T_map_base @ OPTICAL
    T_map_base[2, 3] += TABLE_M - float(np.nanmedian(points[table] @ T[2, :3] + T[2, 3]))
    return replace(view, T_map_base=T_map_base)


def _camera(points: NDArray[np.float64]) -> PinholeCamera:
    """The pinhole camera by which the points of an organised cloud lie on their pixels' rays."""
    v, u = np.nonzero(np.isfinite(points).all(axis=2) & (points[..., 2] > 0))
    x, y, z = points[v, u].T
    fx, cx = np.polyfit(x / z, u, 1)
    fy, cy = np.polyfit(y / z, v, 1)
    return PinholeCamera(WIDTH, HEIGHT, float(fx), float(fy), float(cx), float(cy))
