"""Whether the robot can drive its tour: through doorways and past the things."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

from afkb.errors import SourceError
from afkb.flow import OrientedBox
from afkb_simulation.placing import Placed, room_at
from afkb_simulation.tour import Stop
from afkb_simulation.world_file import WorldFile

_STEPPED_OVER_M = 0.03


def check_way(
    world: WorldFile,
    stops: Sequence[Stop],
    placed: Sequence[Placed],
    present: Callable[[int], Sequence[int]],
    path: Path,
) -> None:
    """Raise `SourceError` where a frame would be taken inside a wall or a thing."""
    boxes = [p.box for p in placed]
    for index, stop in enumerate(stops):
        name = world.tour.waypoints[stop.leg].name
        key = f"{path}: tour.waypoints ({name})"
        at = f"({stop.x:.2f}, {stop.y:.2f})"
        inside = room_at(world, (stop.x, stop.y)) is not None or not world.rooms
        if not inside and not _in_doorway(world, stop):
            raise SourceError(
                f"{key}: the way there leaves the rooms at {at}; "
                "lead it through a doorway with `via`"
            )
        for i in present(index):
            if _hits(stop, boxes[i], _height(world)):
                raise SourceError(
                    f"{key}: the way there runs into {placed[i].thing.name!r} at {at}; "
                    "lead it around with `via`, or move the thing"
                )


def _in_doorway(world: WorldFile, stop: Stop) -> bool:
    return any(math.dist((stop.x, stop.y), d.at) <= d.width / 2 for d in world.doorways)


def _height(world: WorldFile) -> float:
    camera, laser = world.robot.camera, world.robot.laser
    return max(camera.height_m if camera else 0.0, laser.height_m if laser else 0.0)


def _hits(stop: Stop, box: OrientedBox, robot_height: float) -> bool:
    if box.top < _STEPPED_OVER_M or box.bottom > robot_height:
        return False
    dx, dy = stop.x - box.center_xyz[0], stop.y - box.center_xyz[1]
    c, s = math.cos(box.yaw), math.sin(box.yaw)
    along, across = abs(c * dx + s * dy), abs(c * dy - s * dx)
    return along < box.size_xyz[0] / 2 and across < box.size_xyz[1] / 2
