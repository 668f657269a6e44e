"""Rooms of the map against the truth: each one that the robot stood in, by every classifier."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from afkb.flow import Room, TopologicalMap, Truth
from afkb_paper.judged import MS

AFFORDANCES = "affordances"
ALSO_RIGHT = {"ChildsRoom": frozenset({"Bedroom"})}
"""A child's room is a bedroom, by the definition that the ontology states."""


@dataclass(frozen=True, slots=True, eq=False)
class JudgedRoom:
    """A true room that the robot stood in: its category, and the mapped room of most views there.

    `views`: taken there; `shared`: by how many true rooms the mapped one is.
    """

    name: str
    category: str
    views: int
    mapped: Room
    shared: int

    @property
    def beliefs(self) -> Mapping[str, Mapping[str, float]]:
        """What the mapped room is taken for: by its affordances, and by each other classifier."""
        return {AFFORDANCES: self.mapped.belief, **self.mapped.other_beliefs}

    @property
    def right(self) -> frozenset[str]:
        """The categories that are right."""
        return ALSO_RIGHT.get(self.category, frozenset()) | {self.category}

    def told(self, by: str) -> str | None:
        """The likeliest category by a classifier; None where it tells nothing of this room."""
        belief = self.beliefs.get(by)
        return max(belief, key=lambda name: belief[name]) if belief else None

    def is_right(self, by: str) -> bool:
        """Whether a classifier's likeliest category is right."""
        return self.told(by) in self.right


def judged_rooms(found: TopologicalMap, truth: Truth) -> list[JudgedRoom]:
    """Every true room in which views of the map were taken, by name; none where it has no rooms."""
    if not found.rooms:
        return []
    at = {round(v.stamp * MS): v.room for v in truth.views}
    stood: dict[str, Counter[str]] = {}
    for row in found.trajectory:
        if (name := at.get(round(row[0] * MS))) is not None:
            stood.setdefault(name, Counter())[_room_at(found.rooms, row[4], row[8])] += 1
    chosen = {name: counted.most_common(1)[0][0] for name, counted in stood.items()}
    shared = Counter(chosen.values())
    rooms = {room.id: room for room in found.rooms}
    return [
        JudgedRoom(
            name,
            truth.rooms.get(name, ""),
            stood[name].total(),
            rooms[chosen[name]],
            shared[chosen[name]],
        )
        for name in sorted(stood)
    ]


def _room_at(rooms: Sequence[Room], x: float, y: float) -> str:
    import shapely

    point = shapely.Point(x, y)
    return min(rooms, key=lambda r: shapely.Polygon(r.polygon_xy).buffer(0).distance(point)).id
