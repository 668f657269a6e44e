"""The edges of G: ways between places, E_d to obstacles, E_l to bounds, with linkage angles."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from afkb.flow import Bound, Edge, EdgeKind, Entity, RobotPlace
from afkb_mapping.geometry import wrap_angle


def edges_of(
    places: Sequence[RobotPlace],
    ways: Sequence[tuple[str, str, float]],
    entities: Sequence[Entity],
    seen: Mapping[str, Sequence[str]],
    bounds: Sequence[Bound],
) -> Iterator[Edge]:
    """All edges, m and rad in the map frame.

    `ways`: from place to place with the length of the way, which is the weight of such an edge; its
    bearing is that of the straight line. All other distances are straight, E_d to a thing, E_l to
    the nearest point of a bound.

    Between places the linkage angle is |r_θi - r_θj| of the robot's headings, to things and bounds
    it is |r_θi - c_θj| (paper Algorithm 1).
    """
    place_of = {p.id: p for p in places}
    entity_of = {e.id: e for e in entities}
    for source, target, length in ways:
        a, b = place_of[source], place_of[target]
        turn = abs(wrap_angle(a.yaw - b.yaw))
        yield replace(_edge(EdgeKind.PATH, a, b.id, (b.x, b.y), turn), distance=length)
    implied, in_room = _by_place(entities), _by_room(bounds)
    for place in places:
        for id_ in seen[place.id]:
            yield _edge(EdgeKind.OBSTACLE, place, id_, entity_of[id_].position_xyz[:2])
        known = set(seen[place.id])
        for entity in implied[place.id]:
            if entity.id not in known:
                yield _edge(EdgeKind.OBSTACLE, place, entity.id, entity.position_xyz[:2])
        for bound in in_room[place.room] if place.room is not None else ():
            yield _edge(EdgeKind.BOUND, place, bound.id, _nearest_point(bound, place))


def _by_place(entities: Sequence[Entity]) -> Mapping[str, list[Entity]]:
    """What follows from others, by the places from which it was implied or seen."""
    found: defaultdict[str, list[Entity]] = defaultdict(list)
    for entity in entities:
        for place in entity.seen_from if entity.predicted_from else ():
            found[place].append(entity)
    return found


def _by_room(bounds: Sequence[Bound]) -> Mapping[str | None, list[Bound]]:
    found: defaultdict[str | None, list[Bound]] = defaultdict(list)
    for bound in bounds:
        found[bound.room].append(bound)
    return found


def _edge(
    kind: EdgeKind,
    place: RobotPlace,
    target: str,
    xy: tuple[float, float],
    linkage_angle: float | None = None,
) -> Edge:
    dx, dy = xy[0] - place.x, xy[1] - place.y
    bearing = math.atan2(dy, dx)
    if linkage_angle is None:
        linkage_angle = abs(wrap_angle(place.yaw - bearing))
    id_ = f"{place.id}_{target}"
    return Edge(id_, kind, place.id, target, math.hypot(dx, dy), bearing, linkage_angle)


def _nearest_point(bound: Bound, place: RobotPlace) -> tuple[float, float]:
    start, end = np.asarray(bound.start_xy), np.asarray(bound.end_xy)
    along = end - start
    share = float((np.array([place.x, place.y]) - start) @ along / max(along @ along, 1e-12))
    x, y = start + min(max(share, 0.0), 1.0) * along
    return float(x), float(y)
