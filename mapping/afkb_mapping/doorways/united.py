"""Doorways of a map: what views have shown, and what the grid's rooms show, each place once."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from afkb_mapping.doorways.doorway import DoorwayShape
from afkb_mapping.doorways.merger import SeenDoorway
from afkb_mapping.rooms.lookup import room_id

SAME_M, SAME_RAD = 0.5, math.radians(50)
"""Both put a doorway's middle somewhere in the passage; the grid turns it by what lies around."""
BESIDE_M = 0.5
"""Which room a doorway leads to is asked this far from its middle."""

RoomAt = Callable[[float, float], str | None]


@dataclass(frozen=True, slots=True)
class PlacedDoorway:
    """A doorway of the map: middle (m), direction through it (rad), width (m).

    `rooms`: that it connects, two where the grid knows both, else one or none.
    """

    x: float
    y: float
    yaw: float
    width: float
    rooms: tuple[str, ...]


def united(
    of_grid: Sequence[DoorwayShape], seen: Sequence[SeenDoorway], room_at: RoomAt
) -> list[PlacedDoorway]:
    """Those between rooms first, as views have measured them where they have; then the others."""
    left = list(seen)
    placed = []
    for shape in of_grid:
        rooms = (room_id(shape.labels[0]), room_id(shape.labels[1]))
        near = sorted((s for s in left if _is_same(s, shape)), key=lambda s: _off(s, shape))
        if not near:
            placed.append(PlacedDoorway(shape.x, shape.y, shape.yaw, shape.width, rooms))
        else:
            same = near[0]
            left.remove(same)
            yaw = same.yaw if math.cos(same.yaw - shape.yaw) >= 0 else _turned(same.yaw)
            placed.append(PlacedDoorway(same.x, same.y, yaw, same.width, rooms))
    return [*placed, *(_between_rooms(s, room_at) for s in left)]


def _between_rooms(seen: SeenDoorway, room_at: RoomAt) -> PlacedDoorway:
    dx, dy = BESIDE_M * math.cos(seen.yaw), BESIDE_M * math.sin(seen.yaw)
    beside = (room_at(seen.x - dx, seen.y - dy), room_at(seen.x + dx, seen.y + dy))
    rooms = tuple(dict.fromkeys(room for room in beside if room is not None))
    return PlacedDoorway(seen.x, seen.y, seen.yaw, seen.width, rooms)


def _is_same(seen: SeenDoorway, shape: DoorwayShape) -> bool:
    turn = abs((seen.yaw - shape.yaw + math.pi / 2) % math.pi - math.pi / 2)
    return _off(seen, shape) <= max(SAME_M, shape.width / 2) and turn <= SAME_RAD


def _off(seen: SeenDoorway, shape: DoorwayShape) -> float:
    return math.hypot(seen.x - shape.x, seen.y - shape.y)


def _turned(yaw: float) -> float:
    """The opposite direction, in (-pi, pi]."""
    return yaw - math.pi if yaw > 0 else yaw + math.pi
