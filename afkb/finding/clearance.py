"""Whether a hand gets at a thing: room between its box, its neighbours' boxes and the walls.

Boxes stand upright and are turned about the vertical. Everything is in the thing's own frame: `x`
along its length, `y` along its width, its middle at the origin, m.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from afkb.finding.surroundings import Node, Surroundings
from afkb.knowledge.model import Trapezoid

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

FINGER_ROOM = Trapezoid(0.004, 0.02, 3.0, 9.0)
"""Room that a finger needs beside a thing, m: what `clearance_side_m` of the grasps says."""
FINGER_M = 0.08
"""How far fingers reach down beside a thing: length of a middle finger (DIN 33402-2)."""
HAND_LENGTH_M, HAND_BREADTH_M = 0.19, 0.085
"""Of an adult's hand, median (DIN 33402-2): room that it takes behind its fingers."""
NEAR_M = 0.5
"""What is farther from a thing's middle than this and its own half length hinders no hand."""
TOUCH_M = 0.01
"""Boxes that overlap by less in height stand beside or on each other: noise of a depth camera."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """What may hinder a hand: its outline in the thing's frame, its heights, and how surely."""

    id: str
    outline: BaseGeometry
    bottom: float
    top: float
    existence: float
    around: bool
    """Whether the thing is in it, as a cup is in a sink."""


@dataclass(frozen=True, slots=True)
class Room:
    """P(a hand has the room it needs), and what hinders it most."""

    probability: float
    hindered_by: str | None = None
    gap_m: float = math.inf


@dataclass(frozen=True, slots=True)
class Way:
    """A way for a hand to a thing, and the room that it has there.

    `approach`: `above`, or `side`, -1 or 1 of the axis that is not closed along. `axis`: along
    which fingers close, 0 length, 1 width, 2 height.
    """

    approach: str
    axis: int
    side: int
    room: Room


@dataclass(frozen=True)
class Clearance:
    """The room about one thing of a map."""

    node: Node
    around: Surroundings

    @cached_property
    def ways(self) -> tuple[Way, ...]:
        """All ways to the thing, those that come first better if they have as much room."""
        above = [Way("above", axis, 0, self.from_above(axis)) for axis in (0, 1)]
        level = [
            Way("side", axis, side, self.from_side(axis, side))
            for axis in (0, 1)
            for side in (-1, 1)
        ]
        return (*above, *level, Way("side", 2, 0, self.from_below()))

    def from_above(self, axis: int) -> Room:
        """For a hand that comes down and closes along an axis (0 length, 1 width)."""
        low, high = self.node.bottom_top
        across = min(self._half(1 - axis), HAND_BREADTH_M / 2)
        beside = [o for o in self.obstacles if not o.around and o.top > max(low, high - FINGER_M)]
        beside = [o for o in beside if o.bottom < high - TOUCH_M]
        room = _both(self._gaps(beside, axis, side, across) for side in (-1, 1))
        over = self._box(*(self._half(i) + FINGER_ROOM.n1 for i in (0, 1)))
        above = [
            o
            for o in self.obstacles
            if high - TOUCH_M <= o.bottom < high + HAND_LENGTH_M and o.outline.intersects(over)
        ]
        return _both((room, _blocked(above)))

    def from_side(self, axis: int, side: int) -> Room:
        """For a hand that comes level from one side (-1, 1) of the other axis and closes along one.

        What is lower than half a hand's breadth is too low for a hand beside it.
        """
        low, high = self.node.bottom_top
        if high - low < HAND_BREADTH_M / 2:
            return Room(0.0, self.node.supported_by or "the floor", 0.0)
        level = [o for o in self.obstacles if o.top > low + TOUCH_M and o.bottom < high - TOUCH_M]
        beside = [o for o in level if not o.around]
        room = _both(self._gaps(beside, axis, s, self._half(1 - axis)) for s in (-1, 1))
        start, half = self._half(1 - axis), self._half(axis) + FINGER_ROOM.n1
        way = sorted((side * start, side * (start + HAND_LENGTH_M)))
        way_in = self._strip(axis, (-half, half), (way[0], way[1]))
        return _both((room, _blocked([o for o in level if o.outline.intersects(way_in)])))

    def from_below(self) -> Room:
        """For a finger under the thing, which lies on something."""
        return Room(0.0, self.node.supported_by or "what it lies on", 0.0)

    @cached_property
    def obstacles(self) -> list[Obstacle]:
        """All about the thing but what it stands on and what is in its own box.

        Bounds have no height: one that runs under what the thing stands on is its side, no wall.
        """
        from shapely.geometry import LineString, Point, Polygon

        node, found = self.node, []
        own = self._box(self._half(0), self._half(1))
        for other in self.around.nodes.values():
            reach = NEAR_M + max(node.size[:2]) / 2 + max(other.size[:2]) / 2
            if other.id in (node.id, node.supported_by) or not _beside(node, other, reach):
                continue
            outline = Polygon([self._own(*corner) for corner in _corners(other)])
            if own.contains(Point(self._own(other.x, other.y))) and _overlap(node, other):
                continue
            around = bool(outline.contains(Point(0.0, 0.0)))
            found.append(Obstacle(other.id, outline, *other.bottom_top, other.existence, around))
        support = self.around.nodes.get(node.supported_by or "")
        top = Polygon([self._own(*corner) for corner in _corners(support)]) if support else None
        for a, b in self.around.walls:
            line = LineString([self._own(*a), self._own(*b)])
            near = line.distance(Point(0.0, 0.0)) < NEAR_M + max(node.size[:2]) / 2
            if near and not (top and line.intersects(top)):
                found.append(Obstacle("a wall", line, -math.inf, math.inf, 1.0, False))
        return found

    def _gaps(self, beside: list[Obstacle], axis: int, side: int, across: float) -> Room:
        """Room for a finger at one end of an axis, in a strip of half a width `across`."""
        start = self._half(axis)
        ends = sorted((0.0, side * (start + NEAR_M)))
        strip = self._strip(axis, (ends[0], ends[1]), (-across, across))
        rooms = []
        for o in beside:
            part = o.outline.intersection(strip)
            if not part.is_empty:
                low, high = part.bounds[axis], part.bounds[axis + 2]
                gap = max((low if side > 0 else -high) - start, 0.0)
                rooms.append(Room(1.0 - o.existence * (1.0 - FINGER_ROOM(gap)), o.id, gap))
        return _both(rooms)

    def _half(self, axis: int) -> float:
        return self.node.size[axis] / 2

    def _own(self, x: float, y: float) -> tuple[float, float]:
        c, s = math.cos(self.node.yaw), math.sin(self.node.yaw)
        dx, dy = x - self.node.x, y - self.node.y
        return c * dx + s * dy, c * dy - s * dx

    @staticmethod
    def _box(half_x: float, half_y: float) -> BaseGeometry:
        from shapely.geometry import box

        return box(-half_x, -half_y, half_x, half_y)

    @staticmethod
    def _strip(axis: int, along: tuple[float, float], across: tuple[float, float]) -> BaseGeometry:
        from shapely.geometry import box

        x, y = (along, across) if axis == 0 else (across, along)
        return box(x[0], y[0], x[1], y[1])


def _corners(node: Node) -> list[tuple[float, float]]:
    c, s = math.cos(node.yaw), math.sin(node.yaw)
    a, b = max(node.size[0], 1e-3) / 2, max(node.size[1], 1e-3) / 2
    ends = ((a, b), (-a, b), (-a, -b), (a, -b))
    return [(node.x + c * u - s * v, node.y + s * u + c * v) for u, v in ends]


def _beside(node: Node, other: Node, reach: float) -> bool:
    """Whether another node is near, and no support that the thing's foot is on or above."""
    low, _ = node.bottom_top
    below = other.bottom_top[1] <= low + 2 * TOUCH_M
    return not below and math.dist((node.x, node.y), (other.x, other.y)) <= reach


def _overlap(node: Node, other: Node) -> bool:
    (a, b), (c, d) = node.bottom_top, other.bottom_top
    return c < b - TOUCH_M and d > a + TOUCH_M


def _blocked(by: list[Obstacle]) -> Room:
    return _both(Room(1.0 - o.existence, o.id, 0.0) for o in by)


def _both(rooms: Iterable[Room]) -> Room:
    """All of them needed; what hinders most is named."""
    rooms = list(rooms)
    worst = min(rooms, key=lambda r: r.probability, default=Room(1.0))
    return Room(math.prod(r.probability for r in rooms), worst.hindered_by, worst.gap_m)
