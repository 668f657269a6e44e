"""What doors and walls say of a room: how many there are, how long, and the shape they make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from afkb.flow import Room, TopologicalMap

WALL_FROM_M = 1.0
"""A shorter straight piece of a room's outline is a jamb, a pillar or the side of a niche."""
STRAIGHT_WITHIN_M = 0.5
"""Deviations of an outline that a cupboard against a wall makes, or a wall that was half seen."""
OPEN_FROM = 0.5
"""A doorway less likely than this is none."""


@dataclass(frozen=True, slots=True)
class Shape:
    """Of one room: area, m²; doors; straight walls; long over short side of its rectangle.

    The rectangle is the smallest around the room. Its sides, the lengths of the walls of a plain
    room, follow from area and elongation.
    """

    area_m2: float
    doors: int
    walls: int
    elongation: float


def shape_of(room: Room, topological_map: TopologicalMap) -> Shape | None:
    """The shape of a room of a map; None where its outline encloses nothing."""
    import shapely

    if len(room.polygon_xy) < 3 or not room.area > 0:
        return None
    outline = shapely.Polygon(room.polygon_xy).buffer(0)
    plain = outline.simplify(STRAIGHT_WITHIN_M)
    rectangle = shapely.get_coordinates(shapely.minimum_rotated_rectangle(outline))
    short, long = sorted(np.hypot(*np.diff(rectangle[:3], axis=0).T).tolist())
    if not short > 0:
        return None
    sides = [s for p in shapely.get_parts(plain) for s in _sides(shapely.get_coordinates(p))]
    return Shape(
        area_m2=room.area,
        doors=sum(
            room.id in door.rooms and door.existence >= OPEN_FROM
            for door in topological_map.doorways
        ),
        walls=sum(side >= WALL_FROM_M for side in sides),
        elongation=long / short,
    )


def _sides(ring_xy: np.ndarray) -> list[float]:
    lengths: list[float] = np.hypot(*np.diff(ring_xy, axis=0).T).tolist()
    return lengths
