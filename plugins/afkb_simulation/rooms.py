"""Walls, floors, ceilings and doorways of a world, as meshes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from afkb.errors import SourceError
from afkb_simulation.meshes import Mesh, merge, quad
from afkb_simulation.polygons import XY, edges, triangulate
from afkb_simulation.world_file import DoorwayFile, RoomFile, WorldFile

_MAX_WALL = 0.5


@dataclass(frozen=True, slots=True)
class Opening:
    """Where a doorway cuts one side of one room: from `start` to `end` along it, m."""

    room: str
    side: int
    start: float
    end: float
    a: XY
    b: XY
    height: float


def _along(a: XY, b: XY, s: float) -> XY:
    length = math.dist(a, b)
    return a[0] + (b[0] - a[0]) * s / length, a[1] + (b[1] - a[1]) * s / length


def _nearest_side(room: RoomFile, at: XY) -> tuple[int, float, float]:
    """Side of the room nearest to a point: its index, the way along it, the distance; m."""
    found = []
    for i, (a, b) in enumerate(edges(room.corners)):
        length = math.dist(a, b)
        s = ((at[0] - a[0]) * (b[0] - a[0]) + (at[1] - a[1]) * (b[1] - a[1])) / length
        s = min(max(s, 0.0), length)
        found.append((math.dist(at, _along(a, b, s)), i, s))
    distance, i, s = min(found)
    return i, s, distance


def _opening(room: RoomFile, doorway: DoorwayFile, key: str) -> Opening:
    side, s, distance = _nearest_side(room, doorway.at)
    a, b = edges(room.corners)[side]
    if distance > _MAX_WALL:
        raise SourceError(
            f"{key}.at: {distance:.2f} m from the walls of {room.name!r}; move it into the wall"
        )
    start, end = s - doorway.width / 2, s + doorway.width / 2
    if start < -1e-9 or end > math.dist(a, b) + 1e-9:
        raise SourceError(f"{key}: reaches past the wall of {room.name!r}; move or narrow it")
    if doorway.height >= room.wall_height:
        raise SourceError(f"{key}.height: not below the wall height of {room.name!r}; lower it")
    return Opening(
        room.name, side, start, end, _along(a, b, start), _along(a, b, end), doorway.height
    )


def openings(world: WorldFile, path: Path) -> list[tuple[Opening, Opening]]:
    """For each doorway, what it cuts out of the two rooms it joins."""
    rooms = {r.name: r for r in world.rooms}
    found = []
    for i, doorway in enumerate(world.doorways):
        key = f"{path}: doorways[{i}]"
        first, second = (_opening(rooms[name], doorway, key) for name in doorway.between)
        found.append((first, second))
    return found


def _face(a: XY, b: XY, low: float, high: float) -> Mesh:
    return quad((*a, low), (*b, low), (*b, high), (*a, high))


def _walls(room: RoomFile, cuts: list[Opening]) -> list[Mesh]:
    meshes = []
    for side, (a, b) in enumerate(edges(room.corners)):
        here = sorted((c for c in cuts if c.side == side), key=lambda c: c.start)
        at = a
        for cut in here:
            meshes.append(_face(at, cut.a, 0, room.wall_height))
            meshes.append(_face(cut.a, cut.b, cut.height, room.wall_height))
            at = cut.b
        meshes.append(_face(at, b, 0, room.wall_height))
    return meshes


def _level(room: RoomFile, z: float) -> Mesh:
    vertices = np.array([(x, y, z) for x, y in room.corners], dtype=np.float64)
    return Mesh(vertices, np.array(triangulate(room.corners), dtype=np.uint32))


def _passage(first: Opening, second: Opening) -> list[Mesh]:
    """Threshold, lintel and both jambs of the opening through the thickness of the wall."""
    a, b, c, d, h = first.a, first.b, second.a, second.b, first.height
    if math.dist(a, d) > math.dist(a, c):
        c, d = d, c
    meshes = [quad((*a, z), (*b, z), (*c, z), (*d, z)) for z in (0.0, h)]
    return [*meshes, _face(a, d, 0, h), _face(b, c, 0, h)]


def building(world: WorldFile, cuts: list[tuple[Opening, Opening]]) -> Mesh:
    """All that is fixed: walls with their openings, floors, ceilings."""
    meshes = []
    for room in world.rooms:
        own = [o for pair in cuts for o in pair if o.room == room.name]
        meshes += [*_walls(room, own), _level(room, 0.0), _level(room, room.wall_height)]
    for first, second in cuts:
        meshes += _passage(first, second)
    return merge(meshes)
