"""The layers of the plan under its things: grid, rooms, bounds, doorways, edges and the way."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from afkb.drawing import svg as d
from afkb.drawing.png import grid_image
from afkb.drawing.words import best
from afkb.flow import Edge, EdgeKind, OccupancyGrid, TopologicalMap

HUES = 6
"""So many colours tell neighbouring rooms apart."""
# A row of the trajectory is the stamp and then T_map_base, row by row.
_STAMP_AND_POSE = 17
_STAMP_AND_XY = (0, 4, 8)
_STEP_M = 0.05


def occupancy(grid: OccupancyGrid) -> Iterator[str]:
    """The occupancy grid as an image; nothing where there is none."""
    rows, columns = grid.probability.shape
    if not rows or not columns:
        return
    x, y = grid.origin_xy
    height = rows * grid.resolution_m
    yield d.tag(
        "image",
        {
            "x": d.number(x),
            "y": d.number(-(y + height)),
            "width": d.number(columns * grid.resolution_m),
            "height": d.number(height),
            "preserveAspectRatio": "none",
            "href": grid_image(grid.probability),
        },
    )


def rooms(m: TopologicalMap) -> Iterator[str]:
    """Outlines of the rooms, in turning hues."""
    for number, room in enumerate(m.rooms):
        if len(room.polygon_xy) < 3:
            continue
        posterior = ", ".join(f"{name} {p:.2f}" for name, p in best(room.belief, 3))
        title = f"{room.id}: {posterior}; {room.area:.1f} m²"
        yield d.path(f"room hue{number % HUES}", room.polygon_xy, True, title, room.id)


def doorways(m: TopologicalMap) -> Iterator[str]:
    """Doorways as lines from jamb to jamb."""
    for door in m.doorways:
        title = f"{door.id}: doorway {door.width:.2f} m wide, {' - '.join(door.rooms)}"
        jambs = (door.x, door.y, door.yaw + math.pi / 2)
        yield d.ray("doorway", jambs, (-door.width / 2, door.width / 2), title, door.id)


def bounds(m: TopologicalMap) -> Iterator[str]:
    """Walls as they were fitted."""
    for bound in m.bounds:
        title = f"{bound.id}: bound, seen {bound.observations} times"
        yield d.line("bound", bound.start_xy, bound.end_xy, title, bound.id)


def driven(m: TopologicalMap) -> Iterator[str]:
    """The robot's way."""
    way = stamped_way(m.trajectory)
    if len(way) > 1:
        yield d.path("driven", way[:, 1:], False, "the robot's way")


def stamped_way(trajectory: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, 3) stamp (s), x, y (m), 5 cm apart at least: a robot that stands draws nothing new."""
    if not len(trajectory) or trajectory.shape[1] != _STAMP_AND_POSE:
        return np.empty((0, 3))
    way = trajectory[:, _STAMP_AND_XY]
    kept = [way[0]]
    for point in way[1:]:
        if math.dist(point[1:], kept[-1][1:]) >= _STEP_M:
            kept.append(point)
    return np.array(kept)


def places(m: TopologicalMap, radius: float) -> Iterator[str]:
    """The robot's places with their headings, and the ways between them."""
    where = {place.id: (place.x, place.y) for place in m.places}
    for edge in m.edges:
        if edge.kind is EdgeKind.PATH and edge.source in where and edge.target in where:
            title = f"{edge.id}: {edge.distance:.2f} m, bearing {math.degrees(edge.bearing):.0f}°"
            yield _edge("way", edge, where, title)
    for place in m.places:
        ahead = (place.x, place.y, place.yaw)
        yield d.ray("heading", ahead, (0.0, 2 * radius), id_=place.id)
        title = f"{place.id}: robot place{f' in {place.room}' if place.room else ''}"
        yield d.circle("place", place.x, place.y, radius, title, place.id)


def edges(m: TopologicalMap) -> Iterator[str]:
    """Distances that were measured from places to things and bounds."""
    where = {place.id: (place.x, place.y) for place in m.places}
    where |= {e.id: e.position_xyz[:2] for e in m.entities}
    where |= {b.id: _middle(b.start_xy, b.end_xy) for b in m.bounds}
    for edge in m.edges:
        if edge.kind is not EdgeKind.PATH and edge.source in where and edge.target in where:
            kind = "to-bound" if edge.kind is EdgeKind.BOUND else "to-obstacle"
            title = f"{edge.source} to {edge.target}: {edge.distance:.2f} m"
            yield _edge(kind, edge, where, title)


def _edge(kind: str, edge: Edge, where: Mapping[str, tuple[float, float]], title: str) -> str:
    ends = (edge.source, edge.target)
    return d.edge(kind, where[edge.source], where[edge.target], ends, edge.id, title)


def _middle(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
