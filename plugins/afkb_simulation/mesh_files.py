"""Things from mesh files: put on their foot, scaled, with the surface that things stand on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb_simulation.built import Built, Size, Support
from afkb_simulation.file_types import Up
from afkb_simulation.mesh_loading import load_mesh
from afkb_simulation.meshes import Mesh

_LEVEL_COSINE = 0.98
_BIN_M = 0.02


def built_from_file(
    path: Path, size: Size | None, key: str, up: Up | None = None, unit_m: float = 1.0
) -> Built:
    """The mesh, its foot's middle at the origin, scaled to `size` (m) where one is given.

    Its main upper surface is the height at which most of its level area lies.
    """
    mesh = load_mesh(path, up, unit_m, key)
    lower, upper = mesh.bounds
    extent = upper - lower
    if (extent <= 0).any():
        raise SourceError(f"{key}: {path} is flat or empty; give a mesh with width and height")
    scale = np.array(size) / extent if size else np.ones(3)
    foot = np.array([*(lower + upper)[:2] / 2, lower[2]])
    mesh = Mesh((mesh.vertices - foot) * scale, mesh.triangles)
    support = _main_support(mesh)
    top = support.z if support else float(mesh.bounds[1][2])
    return Built(mesh, top, (support,) if support else ())


def _main_support(mesh: Mesh) -> Support | None:
    """The largest level surface, whichever way its triangles are wound."""
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    level = np.abs(normals[:, 2]) > _LEVEL_COSINE * np.maximum(areas, 1e-12)
    heights = corners[..., 2].mean(axis=1)
    level &= heights > _BIN_M
    if not level.any():
        return None
    return _rectangle(corners[level], areas[level], heights[level])


def _rectangle(
    corners: NDArray[np.float64], areas: NDArray[np.float64], heights: NDArray[np.float64]
) -> Support:
    bins = np.floor(heights / _BIN_M).astype(np.int64)
    per_bin = np.bincount(bins, weights=areas)
    # a board has as much area below as above: the higher of two like levels is its top
    most = int(np.nonzero(per_bin > 0.9 * per_bin.max())[0][-1])
    there = corners[np.abs(bins - most) <= 1].reshape(-1, 3)
    (x0, y0), (x1, y1) = there[:, :2].min(axis=0), there[:, :2].max(axis=0)
    z = float(there[:, 2].max())
    return Support(z, float(x0), float(y0), float(x1), float(y1))
