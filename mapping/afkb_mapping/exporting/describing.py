"""What several formats tell alike of a map's nodes: labels, boxes, plain attributes."""

from __future__ import annotations

import math
from collections.abc import Mapping

from afkb.flow import Bound, Doorway, Entity, NodeKind, OrientedBox, RobotPlace, Room

Flat = dict[str, str | float | int | bool]

_DIGITS = 4
"""Of metres, where they are computed: as a stored map has them."""
NO_CATEGORY, NO_ROOM_CATEGORY = "SomethingElse", "UnknownRoom"


def likeliest(belief: Mapping[str, float], else_: str = NO_CATEGORY) -> str:
    """The name of the greatest probability, the first of equals by name; `else_` where none is."""
    return min(belief, key=lambda name: (-belief[name], name), default=else_)


def is_predicted(entity: Entity) -> bool:
    """Whether it is expected and was not seen; what was seen may follow from other things too."""
    return entity.kind is not NodeKind.OBSERVED


def box_of(entity: Entity) -> OrientedBox:
    """The box of a thing: its position is the top of what supports, the centre of what doesn't."""
    x, y, _ = entity.position_xyz
    return OrientedBox((x, y, entity.top_m - entity.size_xyz[2] / 2), entity.size_xyz, entity.yaw)


def flat_place(place: RobotPlace) -> Flat:
    """A place of the robot: m, rad, s."""
    told: Flat = {
        "kind": "RobotPlace",
        "x": place.x,
        "y": place.y,
        "z": 0.0,
        "yaw": place.yaw,
        "stamp": place.stamp,
        "view_index": place.view_index,
    }
    return told | _given(room=place.room)


def flat_entity(entity: Entity) -> Flat:
    """A thing: m, rad, s; of its beliefs the likeliest category and what it affords at 0.5."""
    category = likeliest(entity.category_belief)
    x, y, z = entity.position_xyz
    told: Flat = {
        "kind": entity.kind.value,
        "x": x,
        "y": y,
        "z": z,
        "size_x": entity.size_xyz[0],
        "size_y": entity.size_xyz[1],
        "size_z": entity.size_xyz[2],
        "yaw": entity.yaw,
        "category": category,
        "category_probability": entity.category_belief.get(category, 0.0),
        "affords": " ".join(a for a in sorted(entity.affordances) if entity.affords(a)),
        "existence": entity.existence,
        "movability": entity.movability,
        "matching_weight": entity.matching_weight,
        "observations": entity.observations,
        "first_seen": entity.first_seen,
        "last_seen": entity.last_seen,
        "extent_known": entity.extent_known,
        "predicted": is_predicted(entity),
    }
    return told | _given(
        room=entity.room,
        supported_by=entity.supported_by,
        part_of=entity.part_of,
        state=entity.state.value if entity.state else None,
    )


def flat_bound(bound: Bound) -> Flat:
    """A piece of wall, by its middle: m, s."""
    (x0, y0), (x1, y1) = bound.start_xy, bound.end_xy
    told: Flat = {
        "kind": "Bound",
        "x": round((x0 + x1) / 2, _DIGITS),
        "y": round((y0 + y1) / 2, _DIGITS),
        "z": 0.0,
        "length": round(math.hypot(x1 - x0, y1 - y0), _DIGITS),
        "existence": bound.existence,
        "observations": bound.observations,
        "first_seen": bound.first_seen,
        "last_seen": bound.last_seen,
    }
    return told | _given(room=bound.room)


def flat_doorway(doorway: Doorway) -> Flat:
    """A passage: m, rad."""
    return {
        "kind": "Doorway",
        "x": doorway.x,
        "y": doorway.y,
        "z": 0.0,
        "yaw": doorway.yaw,
        "width": doorway.width,
        "existence": doorway.existence,
        "rooms": " ".join(doorway.rooms),
    }


def flat_room(room: Room) -> Flat:
    """A room, by a point inside: m, m²."""
    category = likeliest(room.belief, NO_ROOM_CATEGORY)
    return {
        "kind": "Room",
        "x": room.x,
        "y": room.y,
        "z": 0.0,
        "area": room.area,
        "category": category,
        "category_probability": room.belief.get(category, 0.0),
        "visited": room.visited,
    }


def _given(**values: str | None) -> Flat:
    """Those that are known: formats of attributes have no word for none."""
    return {name: value for name, value in values.items() if value is not None}
