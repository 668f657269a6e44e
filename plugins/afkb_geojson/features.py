"""The features of a map: a shape each, and what is known of it as plain properties."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from afkb.flow import EdgeKind, Entity, TopologicalMap
from afkb_mapping.exporting.describing import (
    Flat,
    box_of,
    flat_bound,
    flat_doorway,
    flat_entity,
    flat_place,
    flat_room,
)

Feature = dict[str, Any]
Point = Sequence[float]
Placing = Callable[[float, float], tuple[float, float]]


def features(whole: TopologicalMap, placed: Placing) -> Iterator[Feature]:
    """Rooms first, then what is in them, as it is drawn; `placed` gives a point's coordinates.

    Each has an `id` and a property `kind`: `Room`, `Bound`, `Doorway`, `Way`, `RobotPlace`, or the
    class of a thing. Angles are of the map frame, rad; heights and sizes are in m.
    """
    for room in whole.rooms:
        told = flat_room(room) | {"belief": dict(room.belief)}
        yield _feature(room.id, _area(list(room.polygon_xy), (room.x, room.y), placed), told)
    for bound in whole.bounds:
        line = _line([bound.start_xy, bound.end_xy], placed)
        yield _feature(bound.id, line, flat_bound(bound))
    for entity in whole.entities:
        told = flat_entity(entity) | {
            "affordances": dict(entity.affordances),
            "belief": dict(entity.category_belief),
        }
        yield _feature(entity.id, _outline(entity, placed), told)
    for doorway in whole.doorways:
        across = doorway.yaw + math.pi / 2
        dx, dy = (doorway.width / 2 * f(across) for f in (math.cos, math.sin))
        jambs = [(doorway.x - dx, doorway.y - dy), (doorway.x + dx, doorway.y + dy)]
        yield _feature(doorway.id, _line(jambs, placed), flat_doorway(doorway))
    places = {place.id: place for place in whole.places}
    for edge in whole.edges:
        if edge.kind is EdgeKind.PATH and {edge.source, edge.target} <= places.keys():
            ends = [(places[i].x, places[i].y) for i in (edge.source, edge.target)]
            told = {"kind": "Way", "from": edge.source, "to": edge.target}
            told |= {"distance": edge.distance, "bearing": edge.bearing}
            yield _feature(edge.id, _line(ends, placed), told)
    for place in whole.places:
        yield _feature(place.id, _dot((place.x, place.y), placed), flat_place(place))


def _feature(id_: str, geometry: dict[str, Any], told: Flat | dict[str, Any]) -> Feature:
    """Without the position, which the geometry tells; `z` stays."""
    properties = {"id": id_} | {k: v for k, v in told.items() if k not in ("x", "y")}
    return {"type": "Feature", "id": id_, "geometry": geometry, "properties": properties}


def _outline(entity: Entity, placed: Placing) -> dict[str, Any]:
    """What it covers seen from above: its outline, else its box, else its middle."""
    at = entity.position_xyz[:2]
    if entity.polygon_xy is not None and len(entity.polygon_xy) >= 3:
        return _area(list(entity.polygon_xy), at, placed)
    box = box_of(entity)
    dx, dy = box.size_xyz[0] / 2, box.size_xyz[1] / 2
    cos, sin = math.cos(box.yaw), math.sin(box.yaw)
    corners = [
        (at[0] + u * cos - v * sin, at[1] + u * sin + v * cos)
        for u, v in ((-dx, -dy), (dx, -dy), (dx, dy), (-dx, dy))
    ]
    return _area(corners if dx and dy else [], at, placed)


def _dot(at: Point, placed: Placing) -> dict[str, Any]:
    return {"type": "Point", "coordinates": placed(float(at[0]), float(at[1]))}


def _line(points: Sequence[Point], placed: Placing) -> dict[str, Any]:
    return {"type": "LineString", "coordinates": [placed(float(x), float(y)) for x, y in points]}


def _area(ring: Sequence[Point], else_at: Point, placed: Placing) -> dict[str, Any]:
    """A polygon, counter-clockwise and closed; a point where the ring encloses nothing."""
    turned = _turn(ring)
    if not turned:
        return _dot(else_at, placed)
    points = [placed(float(x), float(y)) for x, y in (ring if turned > 0 else ring[::-1])]
    return {"type": "Polygon", "coordinates": [[*points, points[0]]]}


def _turn(ring: Sequence[Point]) -> float:
    """Twice the signed area, m²: positive where the ring runs counter-clockwise."""
    pairs = zip(ring, [*ring[1:], *ring[:1]], strict=True)
    return float(sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs))
