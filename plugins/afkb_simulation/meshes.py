"""Triangle meshes from a few primitives, as plain arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import transform

Vec3 = tuple[float, float, float]
_SEGMENTS = 32
_BOX_FACES = np.array(
    [
        [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
        [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5],
    ],
    dtype=np.uint32,
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """`vertices` (V, 3) float64, m; `triangles` (T, 3) uint32 indexes into them."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.uint32]

    def moved(self, T: NDArray[np.float64]) -> Mesh:
        """The same mesh after a rigid motion (4x4)."""
        return Mesh(np.asarray(transform(T, self.vertices), dtype=np.float64), self.triangles)

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest corner of its axis-aligned box, (3,) m each."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)


def merge(meshes: Sequence[Mesh]) -> Mesh:
    """One mesh of several."""
    offsets = np.cumsum([0, *(len(m.vertices) for m in meshes[:-1])])
    triangles = [m.triangles + np.uint32(o) for m, o in zip(meshes, offsets, strict=True)]
    return Mesh(np.concatenate([m.vertices for m in meshes]), np.concatenate(triangles))


def box(lower: Vec3, upper: Vec3) -> Mesh:
    """Axis-aligned solid between two corners, m."""
    xs, ys, zs = zip(lower, upper, strict=True)
    corners = [(x, y, z) for z in zs for y in ys for x in xs]
    return Mesh(np.array(corners, dtype=np.float64), _BOX_FACES)


def quad(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> Mesh:
    """A flat face through four corners in order, m."""
    faces = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    return Mesh(np.array([a, b, c, d], dtype=np.float64), faces)


def open_box(lower: Vec3, upper: Vec3, wall: float, floor: float) -> Mesh:
    """A box without a lid: four walls and a floor of the given thickness, m."""
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    return merge(
        [
            box((x0, y0, z0), (x1, y1, z0 + floor)),
            box((x0, y0, z0 + floor), (x0 + wall, y1, z1)),
            box((x1 - wall, y0, z0 + floor), (x1, y1, z1)),
            box((x0 + wall, y0, z0 + floor), (x1 - wall, y0 + wall, z1)),
            box((x0 + wall, y1 - wall, z0 + floor), (x1 - wall, y1, z1)),
        ]
    )


def rounded_bar(lower: Vec3, upper: Vec3, along: int) -> Mesh:
    """A box whose upper side is a half round along axis 0 (x) or 1 (y), as padding is; m."""
    across = 1 - along
    w0, w1, z0, z1 = lower[across], upper[across], lower[2], upper[2]
    middle, half = (w0 + w1) / 2, (w1 - w0) / 2
    rise = min(half, z1 - z0)
    arc = np.linspace(0, np.pi, _SEGMENTS // 2 + 1)
    w = np.concatenate([[w0, w1], middle + half * np.cos(arc)])
    z = np.concatenate([[z0, z0], z1 - rise + rise * np.sin(arc)])
    ends = []
    for at in (lower[along], upper[along]):
        columns = (np.full(w.size, at), w) if along == 0 else (w, np.full(w.size, at))
        ends.append(np.stack([*columns, z], axis=-1))
    return Mesh(np.concatenate(ends), _prism_faces(w.size))


def _prism_faces(n: int) -> NDArray[np.uint32]:
    """Triangles of a convex prism: one end's n corners, then the other's."""
    i = np.arange(n)
    j = (i + 1) % n
    sides = [np.stack([i, j, j + n], axis=-1), np.stack([i, j + n, i + n], axis=-1)]
    fan = np.stack([np.zeros(n - 2, dtype=np.int64), i[1:-1], i[2:]], axis=-1)
    return np.concatenate([*sides, fan, fan + n]).astype(np.uint32)


def lathe(profile_rz: Sequence[tuple[float, float]], stretch_y: float = 1.0) -> Mesh:
    """Surface of revolution about z through (radius, height) points, m; y may be stretched."""
    rz = np.array(profile_rz, dtype=np.float64)
    angles = np.linspace(0, 2 * np.pi, _SEGMENTS, endpoint=False)
    x = rz[:, :1] * np.cos(angles)
    y = rz[:, :1] * np.sin(angles) * stretch_y
    z = np.broadcast_to(rz[:, 1:], x.shape)
    here = np.arange(x.size).reshape(x.shape)
    along = np.roll(here, -1, axis=1)
    a, b, c, d = here[:-1], along[:-1], along[1:], here[1:]
    faces = [np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)]
    triangles = np.concatenate([f.reshape(-1, 3) for f in faces]).astype(np.uint32)
    return Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles)


def ellipsoid(size: Vec3) -> Mesh:
    """A ball or cushion that lies on z = 0, m."""
    polar = np.linspace(0, np.pi, _SEGMENTS // 2 + 1)
    r, h = size[0] / 2, size[2] / 2
    profile = [(r * float(np.sin(a)), h * (1 - float(np.cos(a)))) for a in polar]
    return lathe(profile, size[1] / size[0])
