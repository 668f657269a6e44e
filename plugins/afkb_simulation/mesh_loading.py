"""Reads mesh files (glTF, OBJ, PLY, STL, OFF) with trimesh, whole scenes too, and turns z up."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb_simulation.file_types import Up
from afkb_simulation.meshes import Mesh

_Y_UP_FORMATS = (".glb", ".gltf")
_Z_FROM_Y_UP: NDArray[np.float64] = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
"""Right-handed y up to right-handed z up: what pointed up points along z."""


def load_mesh(path: Path, up: Up | None, unit_m: float, key: str) -> Mesh:
    """All triangles of a file where its scene graph puts them, z up, m.

    `up`: which axis of the file points up; None stands for glTF's y, and z elsewhere. `key`: where
    the world file names it. Raises `SourceError` where there is no triangle to be had.
    """
    if not path.is_file():
        raise SourceError(f"{key}: no mesh file {path}; paths count from the world file's folder")
    mesh = _loaded(path, key)
    vertices = np.asarray(mesh.vertices, dtype=np.float64) * unit_m
    triangles = np.asarray(mesh.faces, dtype=np.uint32)
    if len(triangles) == 0 or not np.isfinite(vertices).all():
        raise SourceError(
            f"{key}: {path} holds no triangles; give a glTF, OBJ, PLY, STL or OFF mesh"
        )
    if not np.ptp(vertices, axis=0).any():
        raise SourceError(
            f"{key}: {path}: all its corners are at one place, as where Draco compresses them; "
            "export it without compression"
        )
    if (up or ("y" if path.suffix.lower() in _Y_UP_FORMATS else "z")) == "y":
        vertices = vertices @ _Z_FROM_Y_UP.T
    return Mesh(np.ascontiguousarray(vertices), triangles)


def _loaded(path: Path, key: str) -> Any:
    import trimesh

    logging.getLogger("trimesh").addHandler(logging.NullHandler())  # what is wrong is told below
    try:
        scene = trimesh.load_scene(path, process=False, skip_materials=True)
        meshes = [g for g in scene.dump() if isinstance(g, trimesh.Trimesh) and len(g.faces)]
    except Exception as error:  # trimesh lets errors of struct, JSON, numpy and its readers through
        why = " ".join(str(error).split()) or type(error).__name__
        raise SourceError(
            f"{key}: {path} can't be read as a mesh: {why}; export it again as glTF or OBJ"
        ) from error
    if not meshes:
        raise SourceError(
            f"{key}: {path} holds no triangles; give a glTF, OBJ, PLY, STL or OFF mesh"
        )
    return trimesh.util.concatenate(meshes)
