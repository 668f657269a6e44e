"""Casts rays into a world with Open3D: exact depth images and laser ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import PinholeCamera
from afkb_simulation.meshes import Mesh


@dataclass(frozen=True, slots=True, eq=False)
class Hits:
    """What rays met, arrays of one shape.

    `distances` in units of each ray's direction, inf for nothing; `cosines` of incidence, 0..1;
    `meshes` the index of the mesh hit, -1 for none.
    """

    distances: NDArray[np.float32]
    cosines: NDArray[np.float32]
    meshes: NDArray[np.int32]


def import_open3d() -> Any:
    """Open3D, imported where it is used: it takes a second, and system libraries."""
    try:
        import open3d
    except (ImportError, OSError) as error:
        raise SourceError(
            f"ray casting needs Open3D, which doesn't load: {error}; on Debian or Ubuntu: "
            "apt-get install libusb-1.0-0 libgl1 libegl1 libgomp1"
        ) from error
    return open3d


class Caster:
    """Meshes ready for ray casting."""

    def __init__(self, meshes: Sequence[Mesh]) -> None:
        o3d = import_open3d()
        self._as_tensor = o3d.core.Tensor.from_numpy
        self._scene: Any = o3d.t.geometry.RaycastingScene()
        for mesh in meshes:
            vertices = self._as_tensor(mesh.vertices.astype(np.float32))
            self._scene.add_triangles(vertices, self._as_tensor(mesh.triangles))

    def cast(self, origin: NDArray[np.float64], directions: NDArray[np.float32]) -> Hits:
        """First hits of rays from one point (3,) along directions (..., 3), world frame, m."""
        shape = directions.shape[:-1]
        rays = np.empty((*shape, 6), dtype=np.float32)
        rays[..., :3] = origin
        rays[..., 3:] = directions
        found = self._scene.cast_rays(self._as_tensor(rays))
        normals = found["primitive_normals"].numpy()
        along = np.abs(np.einsum("...i,...i->...", normals, directions))
        lengths = np.sqrt(np.einsum("...i,...i->...", directions, directions))
        meshes = found["geometry_ids"].numpy().astype(np.int32)
        return Hits(found["t_hit"].numpy(), along / lengths, meshes)


def camera_rays(camera: PinholeCamera) -> NDArray[np.float32]:
    """(H, W, 3) directions in the optical frame with z = 1: hits come out as depth."""
    u, v = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    x, y = (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy
    return np.stack([x, y, np.ones_like(x)], axis=-1).astype(np.float32)


def laser_rays(angles: NDArray[np.float64]) -> NDArray[np.float32]:
    """(N, 3) unit directions in the laser's plane."""
    flat = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)
    return flat.astype(np.float32)


def turned(T: NDArray[np.float64], directions: NDArray[np.float32]) -> NDArray[np.float32]:
    """Directions (..., 3) of a frame in the frame that T (4x4) leads to."""
    R = T[:3, :3].astype(np.float32)
    return np.ascontiguousarray(directions @ R.T)
