"""The robot's way: true base poses, frame by frame, through the waypoints."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from afkb_mapping.geometry import wrap_angle
from afkb_simulation.polygons import XY
from afkb_simulation.world_file import TourFile, WaypointFile

_FINE_M = 0.05
_FINE_RAD = math.radians(4)


@dataclass(frozen=True, slots=True)
class Stop:
    """One pose on the way, m and rad; `leg` is the waypoint it leads to, `look` if it is there."""

    x: float
    y: float
    yaw: float
    leg: int
    look: bool = False


def _turn(stop: Stop, yaw: float) -> Iterator[Stop]:
    by = wrap_angle(yaw - stop.yaw)
    n = max(1, math.ceil(abs(by) / _FINE_RAD))
    for k in range(1, n + 1):
        yield replace(stop, yaw=wrap_angle(stop.yaw + by * k / n), look=False)


def _drive(stop: Stop, to: XY) -> Iterator[Stop]:
    length = math.dist((stop.x, stop.y), to)
    if length < 1e-6:
        return
    yaw = math.atan2(to[1] - stop.y, to[0] - stop.x)
    yield from _turn(stop, yaw)
    n = math.ceil(length / _FINE_M)
    for k in range(1, n + 1):
        x = stop.x + (to[0] - stop.x) * k / n
        y = stop.y + (to[1] - stop.y) * k / n
        yield replace(stop, x=x, y=y, yaw=yaw)


def _leg(start: Stop, waypoint: WaypointFile) -> list[Stop]:
    way = [start]
    for corner in (*waypoint.via, waypoint.at):
        way += _drive(way[-1], corner)
    for look in waypoint.looks_deg:
        way += _turn(way[-1], math.radians(waypoint.yaw_deg + look))
        way.append(replace(way[-1], look=True))
    return way


def _start(tour: TourFile) -> Stop:
    first = tour.waypoints[0]
    look = first.looks_deg[0]
    if not first.via:
        return Stop(*first.at, wrap_angle(math.radians(first.yaw_deg + look)), 0)
    (x0, y0), (x1, y1) = [*first.via, first.at][:2]
    return Stop(x0, y0, math.atan2(y1 - y0, x1 - x0), 0)


def _fine(tour: TourFile) -> list[Stop]:
    way = [_start(tour)]
    for i, waypoint in enumerate(tour.waypoints):
        way += _leg(replace(way[-1], leg=i, look=False), waypoint)
    return way


def stops(tour: TourFile) -> list[Stop]:
    """The poses at which a frame is taken: every look, and as few as it takes between them."""
    fine = _fine(tour)
    taken = [fine[0]]
    for before, stop in pairwise(fine):
        if _too_far(taken[-1], stop, tour):
            taken.append(before)
        if stop.look and _same_pose(taken[-1], stop):
            taken[-1] = stop
        elif stop.look:
            taken.append(stop)
    return taken


def _same_pose(a: Stop, b: Stop) -> bool:
    return math.dist((a.x, a.y), (b.x, b.y)) < 1e-9 and abs(wrap_angle(a.yaw - b.yaw)) < 1e-9


def _too_far(a: Stop, b: Stop, tour: TourFile) -> bool:
    turned = abs(wrap_angle(b.yaw - a.yaw))
    far = math.dist((a.x, a.y), (b.x, b.y)) > tour.step_m + 1e-9
    return far or turned > math.radians(tour.turn_deg) + 1e-9
