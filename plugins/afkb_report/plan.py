"""The plan of the map: grid, rooms, bounds, places and things, in the paper's colours."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from afkb.flow import EdgeKind, Entity, NodeKind, TopologicalMap
from afkb_report import drawing as d
from afkb_report.png import grid_image
from afkb_report.words import best, describe, role

LAYERS = ("grid", "rooms", "bounds", "path", "edges", "things", "labels", "ids")
_MARGIN_M = 0.5
# Lower than this lies the floor, whose outline must not tint all that stands on it.
_GROUND_M = 0.05
# A row of the trajectory is the stamp and then T_map_base, row by row.
_STAMP_AND_POSE = 17
_POSE_XY = (4, 8)


def plan(topological_map: TopologicalMap) -> str:
    """The plan as one `<svg>`, a group per layer, tooltips on everything."""
    west, south, east, north = _extent(topological_map)
    radius = 0.008 * max(east - west, north - south, 5.0)
    layers = {
        "grid": _grid(topological_map),
        "rooms": _rooms(topological_map),
        "bounds": _bounds(topological_map),
        "path": _path(topological_map, radius),
        "edges": _edges(topological_map),
        "things": _things(topological_map, radius),
        "labels": _labels(topological_map, radius),
        "ids": _ids(topological_map, radius),
    }
    view = f"{d.number(west)} {d.number(-north)} {d.number(east - west)} {d.number(north - south)}"
    size = f"--label:{d.number(1.6 * radius)}px"
    groups = "\n".join(d.group(name, layers[name]) for name in LAYERS)
    scale = _scale_bar(west, south, max(east - west, north - south))
    return (
        f'<svg class="plan" viewBox="{view}" style="{size}" role="img" '
        f'aria-label="Plan of the map">\n{groups}\n{scale}\n</svg>'
    )


def _extent(m: TopologicalMap) -> tuple[float, float, float, float]:
    """West, south, east and north of what is known, with a margin, m."""
    points = [(p.x, p.y) for p in m.places] + [e.position_xyz[:2] for e in m.entities]
    points += [end for b in m.bounds for end in (b.start_xy, b.end_xy)]
    rows, columns = np.nonzero(np.isfinite(m.grid.probability))
    if rows.size:
        low = np.array([columns.min(), rows.min()]) * m.grid.resolution_m + m.grid.origin_xy
        high = np.array([columns.max() + 1, rows.max() + 1]) * m.grid.resolution_m
        points += [tuple(low), tuple(high + np.array(m.grid.origin_xy))]
    corners = np.array(points or [(0.0, 0.0)], dtype=np.float64)
    west, south = corners.min(axis=0) - _MARGIN_M
    east, north = corners.max(axis=0) + _MARGIN_M
    return float(west), float(south), float(east), float(north)


def _grid(m: TopologicalMap) -> Iterator[str]:
    rows, columns = m.grid.probability.shape
    if not rows or not columns:
        return
    x, y = m.grid.origin_xy
    height = rows * m.grid.resolution_m
    yield d.tag(
        "image",
        {
            "x": d.number(x),
            "y": d.number(-(y + height)),
            "width": d.number(columns * m.grid.resolution_m),
            "height": d.number(height),
            "preserveAspectRatio": "none",
            "href": grid_image(m.grid.probability),
        },
    )


def _rooms(m: TopologicalMap) -> Iterator[str]:
    for number, room in enumerate(m.rooms):
        if len(room.polygon_xy) < 3:
            continue
        posterior = ", ".join(f"{name} {p:.2f}" for name, p in best(room.belief, 3))
        yield d.path(
            f"room hue{number % 6}",
            room.polygon_xy,
            True,
            f"{room.id}: {posterior}; {room.area:.1f} m²",
        )
    for door in m.doorways:
        across = door.yaw + math.pi / 2
        half = np.array([math.cos(across), math.sin(across)]) * door.width / 2
        middle = np.array([door.x, door.y])
        title = f"{door.id}: doorway {door.width:.2f} m wide, {' - '.join(door.rooms)}"
        yield d.line("doorway", middle - half, middle + half, title)


def _bounds(m: TopologicalMap) -> Iterator[str]:
    for bound in m.bounds:
        title = f"{bound.id}: bound, seen {bound.observations} times"
        yield d.line("bound", bound.start_xy, bound.end_xy, title)


def _path(m: TopologicalMap, radius: float) -> Iterator[str]:
    if len(m.trajectory) > 1 and m.trajectory.shape[1] == _STAMP_AND_POSE:
        yield d.path("driven", _thinned(m.trajectory[:, _POSE_XY]), False, "the robot's way")
    where = {place.id: (place.x, place.y) for place in m.places}
    for edge in m.edges:
        if edge.kind is EdgeKind.PATH and edge.source in where and edge.target in where:
            title = f"{edge.id}: {edge.distance:.2f} m, bearing {math.degrees(edge.bearing):.0f}°"
            yield d.line("way", where[edge.source], where[edge.target], title)
    for place in m.places:
        ahead = (
            place.x + 2 * radius * math.cos(place.yaw),
            place.y + 2 * radius * math.sin(place.yaw),
        )
        yield d.line("heading", (place.x, place.y), ahead)
        title = f"{place.id}: robot place{f' in {place.room}' if place.room else ''}"
        yield d.circle("place", place.x, place.y, radius, title)


def _thinned(points: np.ndarray, least_m: float = 0.05) -> list[np.ndarray]:
    """Points at least so far apart: a robot that stands still draws nothing new."""
    kept = [points[0]]
    for point in points[1:]:
        if float(np.hypot(*(point - kept[-1]))) >= least_m:
            kept.append(point)
    return kept


def _edges(m: TopologicalMap) -> Iterator[str]:
    where = {place.id: (place.x, place.y) for place in m.places}
    where |= {e.id: e.position_xyz[:2] for e in m.entities}
    where |= {b.id: _middle(b.start_xy, b.end_xy) for b in m.bounds}
    for edge in m.edges:
        if edge.kind is not EdgeKind.PATH and edge.source in where and edge.target in where:
            kind = "to-bound" if edge.kind is EdgeKind.BOUND else "to-obstacle"
            title = f"{edge.source} to {edge.target}: {edge.distance:.2f} m"
            yield d.line(kind, where[edge.source], where[edge.target], title)


def _middle(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _things(m: TopologicalMap, radius: float) -> Iterator[str]:
    """Large ones first, so that what stands on a table can be pointed at."""
    order = sorted(m.entities, key=lambda e: (-e.size_xyz[0] * e.size_xyz[1], e.id))
    for entity in order:
        yield _outline(entity)
    for entity in order:
        x, y, _ = entity.position_xyz
        size = radius if role(entity) == "support" else 0.7 * radius
        yield d.circle(f"node {_classes(entity)}", x, y, size, describe(entity))


def _classes(entity: Entity) -> str:
    seen = "seen" if entity.kind is NodeKind.OBSERVED else "predicted"
    order = {NodeKind.DUAL: " dual", NodeKind.CO_OCCURRENCE: " co-occurrence"}
    moves = " dynamic" if entity.movability == "Dynamic" else ""
    return f"{role(entity)} {seen}{order.get(entity.kind, '')}{moves}"


def _outline(entity: Entity) -> str:
    x, y, _ = entity.position_xyz
    corners: d.Points = d.box_corners(x, y, entity.size_xyz[0], entity.size_xyz[1], entity.yaw)
    if entity.polygon_xy is not None and len(entity.polygon_xy) > 2:
        corners = entity.polygon_xy
    kind = f"outline {_classes(entity)}"
    kind += "" if entity.extent_known else " extent-unknown"
    kind += " ground" if entity.position_xyz[2] < _GROUND_M else ""
    return d.path(kind, corners, True, describe(entity))


def _labels(m: TopologicalMap, radius: float) -> Iterator[str]:
    for room in m.rooms:
        name, p = best(room.belief, 1)[0] if room.belief else ("", 0.0)
        yield d.text("room-label", room.x, room.y, f"{name} {p:.2f}")
    for place in m.places:
        yield d.text("label", place.x, place.y + 1.3 * radius, place.id)


def _ids(m: TopologicalMap, radius: float) -> Iterator[str]:
    for entity in m.entities:
        x, y, _ = entity.position_xyz
        yield d.text("label", x, y + 1.3 * radius, entity.id)


def _scale_bar(west: float, south: float, extent: float) -> str:
    """A bar of 1, 2, 5 or 10 m, at most a sixth of the plan, in its lower left corner."""
    length = max((m for m in (1, 2, 5, 10) if m <= extent / 6), default=1)
    x, y = west + 0.02 * extent, south + 0.02 * extent
    bar = d.line("ruler", (x, y), (x + length, y))
    name = d.text("label", x + length / 2, y + 0.006 * extent, f"{length} m")
    return d.group("scale", [bar, name])
