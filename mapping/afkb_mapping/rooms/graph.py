"""The graph of rooms: doorways that are believed in, and which rooms one can pass between."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from afkb.flow import Doorway
from afkb_mapping.doorways.doorway import DoorwayShape
from afkb_mapping.doorways.judge import UNKNOWN_HEIGHT, DoorwayJudge
from afkb_mapping.doorways.merger import SeenDoorway
from afkb_mapping.doorways.united import RoomAt, united
from afkb_mapping.rooms.lookup import room_id
from afkb_mapping.rooms.rooms import Segmentation

WIDEST_M = 2.5
"""A wider opening, even of a sliding door, is no doorway: two parts of an open plan meet there."""
AS_LIKELY = 0.9 * UNKNOWN_HEIGHT**2
"""What the grid alone takes for a doorway is one unless it is less likely than a gap of which no
view has told how tall its jambs are."""


def doorways_of(
    segmentation: Segmentation, seen: Sequence[SeenDoorway], judge: DoorwayJudge, room_at: RoomAt
) -> tuple[Doorway, ...]:
    """The doorways between rooms, and those that views have shown besides."""
    believed = [d for d in segmentation.doorways if is_doorway(d, judge)]
    return tuple(
        Doorway(f"doorway-{i}", d.x, d.y, d.yaw, d.width, d.rooms)
        for i, d in enumerate(united(believed, seen, room_at), start=1)
    )


def is_doorway(shape: DoorwayShape, judge: DoorwayJudge) -> bool:
    """Whether an opening that the grid shows has jambs that may be of walls, and leads on."""
    half = shape.width / 2 * np.array([-np.sin(shape.yaw), np.cos(shape.yaw)])
    jambs = np.array([shape.x, shape.y]) + np.array([-half, half])
    return shape.width <= WIDEST_M and judge.doorway(jambs, 1.0) >= AS_LIKELY


def connections(
    segmentation: Segmentation, doorways: Sequence[Doorway]
) -> dict[str, tuple[str, ...]]:
    """By room, those that one gets to from it without passing a third, doorway or none."""
    pairs = [(room_id(a), room_id(b)) for a, b in segmentation.connected]
    pairs += [(d.rooms[0], d.rooms[1]) for d in doorways if len(d.rooms) == 2]
    beside: dict[str, set[str]] = {}
    for a, b in pairs:
        beside.setdefault(a, set()).add(b)
        beside.setdefault(b, set()).add(a)
    return {room: tuple(sorted(others)) for room, others in sorted(beside.items())}
