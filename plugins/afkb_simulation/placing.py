"""Puts the things of a world where they stand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import OrientedBox
from afkb_mapping.geometry import T_from_xy_yaw, yaw_of
from afkb_simulation.built import Built
from afkb_simulation.meshes import Mesh
from afkb_simulation.polygons import XY, contains
from afkb_simulation.shapes import SHAPES
from afkb_simulation.world_file import ThingFile, WorldFile


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A thing in the world frame: its mesh, and `T_world_thing` (4x4) from its own frame."""

    thing: ThingFile
    built: Built
    T_world_thing: NDArray[np.float64]
    room: str

    @property
    def mesh(self) -> Mesh:
        """Its surface, world frame."""
        return self.built.mesh.moved(self.T_world_thing)

    @property
    def top_height(self) -> float:
        """Height of its main upper surface, or rim, above the floor, m."""
        return float(self.T_world_thing[2, 3]) + self.built.top_m

    @property
    def box(self) -> OrientedBox:
        """The upright box around it, world frame."""
        lower, upper = self.built.mesh.bounds
        middle = self.T_world_thing @ [*((lower + upper) / 2), 1.0]
        size = upper - lower
        return OrientedBox(
            (float(middle[0]), float(middle[1]), float(middle[2])),
            (float(size[0]), float(size[1]), float(size[2])),
            yaw_of(self.T_world_thing),
        )


def room_at(world: WorldFile, point: XY) -> str | None:
    """Name of the room around a point, m; None in a wall, a doorway or outside."""
    return next((r.name for r in world.rooms if contains(r.corners, point)), None)


def place_all(world: WorldFile, path: Path) -> list[Placed]:
    """Every thing where it stands, in the file's order."""
    by_name = {t.name: t for t in world.things}
    placed: dict[str, Placed] = {}
    for thing in world.things:
        _place(thing, by_name, placed, world, path)
    return [placed[t.name] for t in world.things]


def _place(
    thing: ThingFile,
    by_name: dict[str, ThingFile],
    placed: dict[str, Placed],
    world: WorldFile,
    path: Path,
) -> Placed:
    if thing.name in placed:
        return placed[thing.name]
    carrier = _place(by_name[thing.on], by_name, placed, world, path) if thing.on else None
    T = T_from_xy_yaw(*thing.at, math.radians(thing.yaw_deg))
    T[2, 3] = thing.z
    if carrier:
        T = _T_world_support(carrier, thing, path) @ T
    room = room_at(world, (float(T[0, 3]), float(T[1, 3])))
    if room is None and world.rooms:
        raise SourceError(f"{path}: things ({thing.name}).at: in no room; move it into one")
    built = _build(thing, path)
    placed[thing.name] = Placed(thing, built, T, room or "")
    return placed[thing.name]


def _build(thing: ThingFile, path: Path) -> Built:
    if thing.file is None:
        return SHAPES[thing.shape].build(thing.dimensions, thing.parameters)
    from afkb_simulation.mesh_files import built_from_file

    key = f"{path}: things ({thing.name}).file"
    return built_from_file(path.parent / thing.file, thing.size, key, thing.up, thing.unit_m)


def _T_world_support(carrier: Placed, thing: ThingFile, path: Path) -> NDArray[np.float64]:
    """Frame in the middle of the surface that the thing stands on."""
    key = f"{path}: things ({thing.name})"
    supports = carrier.built.supports
    if thing.level >= len(supports):
        raise SourceError(
            f"{key}.level: a {carrier.thing.shape} has {len(supports)} surfaces to stand on "
            f"(from 0), not level {thing.level}; choose another"
        )
    support = supports[thing.level]
    x, y = support.center_xy
    if abs(thing.at[0]) > support.x1 - x or abs(thing.at[1]) > support.y1 - y:
        raise SourceError(
            f"{key}.at: beyond the edge of {carrier.thing.name!r}, which reaches "
            f"{support.x1 - x:.2f} by {support.y1 - y:.2f} m from its middle; move it in"
        )
    T = np.eye(4)
    T[:3, 3] = x, y, support.z
    return carrier.T_world_thing @ T
