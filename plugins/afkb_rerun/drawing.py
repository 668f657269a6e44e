"""A finished map in Rerun: what stands where, from when on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from afkb.flow import EdgeKind, Entity, OccupancyGrid, TopologicalMap
from afkb_mapping.exporting.describing import NO_ROOM_CATEGORY, box_of, is_predicted, likeliest
from afkb_rerun.stream import STAMPS, rerun

SEEN, MOVABLE, EXPECTED = (128, 128, 128), (210, 140, 40), (70, 130, 220)
"""Colours: what stands there, what moves, and what is only expected."""
_WALL, _DOOR, _WAY, _ROOM = (90, 90, 90), (60, 160, 90), (180, 60, 60), (150, 110, 190)
_UNKNOWN_GREY = 128


def draw(stream: Any, whole: TopologicalMap) -> None:
    """Log a map under `map/`.

    Grid, rooms, walls, doorways and ways hold for all times. A thing appears when it was first
    seen, a prediction when it was made; one that came to an end goes then. The robot moves along
    its way.
    """
    _draw_grid(stream, whole.grid)
    _draw_lines(stream, whole)
    for entity in whole.entities:
        stream.set_time(STAMPS, duration=entity.first_seen)
        _draw_entity(stream, entity)
    _draw_past(stream, whole)
    _draw_way(stream, whole)


def _draw_grid(stream: Any, grid: OccupancyGrid) -> None:
    rr = rerun()
    rows, cols = grid.probability.shape
    if not rows or not cols:
        return
    grey = np.full((rows, cols), _UNKNOWN_GREY, dtype=np.uint8)
    known = np.isfinite(grid.probability)
    grey[known] = np.round(255 * (1 - np.clip(grid.probability[known], 0, 1))).astype(np.uint8)
    (x, y), width, height = grid.origin_xy, cols * grid.resolution_m, rows * grid.resolution_m
    corners = [(x, y, 0), (x + width, y, 0), (x + width, y + height, 0), (x, y + height, 0)]
    mesh = rr.Mesh3D(
        vertex_positions=corners,
        triangle_indices=[(0, 1, 2), (0, 2, 3)],
        vertex_texcoords=[(0, 1), (1, 1), (1, 0), (0, 0)],
        albedo_texture=np.repeat(grey[::-1, :, None], 3, axis=2),
    )
    stream.log("map/grid", mesh, static=True)


def _draw_lines(stream: Any, whole: TopologicalMap) -> None:
    rooms = [[*r.polygon_xy.tolist(), r.polygon_xy[0].tolist()] for r in whole.rooms]
    names = [f"{r.id}: {likeliest(r.belief, NO_ROOM_CATEGORY)}" for r in whole.rooms]
    doors = []
    for d in whole.doorways:
        dx, dy = -math.sin(d.yaw) * d.width / 2, math.cos(d.yaw) * d.width / 2
        doors.append([(d.x - dx, d.y - dy), (d.x + dx, d.y + dy)])
    at = {p.id: (p.x, p.y) for p in whole.places}
    ways = [[at[e.source], at[e.target]] for e in whole.edges if e.kind is EdgeKind.PATH]
    walls = [[b.start_xy, b.end_xy] for b in whole.bounds]
    _log_strips(stream, "map/rooms", rooms, _ROOM, names)
    _log_strips(stream, "map/bounds", walls, _WALL, [b.id for b in whole.bounds])
    _log_strips(stream, "map/doorways", doors, _DOOR, [d.id for d in whole.doorways])
    _log_strips(stream, "map/ways", ways, _WAY, [])


def _log_strips(
    stream: Any, path: str, lines: list[Any], color: tuple[int, int, int], labels: list[str]
) -> None:
    if lines:
        rr = rerun()
        raised = [[(float(x), float(y), 0.01) for x, y in line] for line in lines]
        shown = rr.LineStrips3D(raised, colors=color, labels=labels or None, show_labels=False)
        stream.log(path, shown, static=True)


def _draw_entity(stream: Any, entity: Entity) -> None:
    rr, box = rerun(), box_of(entity)
    dynamic = entity.movability == "Dynamic"
    group = "expected" if is_predicted(entity) else "dynamic" if dynamic else "observed"
    color = EXPECTED if is_predicted(entity) else MOVABLE if dynamic else SEEN
    label = f"{likeliest(entity.category_belief)} {entity.existence:.2f}"
    shown = rr.Boxes3D(
        centers=[box.center_xyz],
        sizes=[box.size_xyz],
        quaternions=[_about_z(box.yaw)],
        colors=[(*color, round(255 * entity.existence))],
        labels=[label],
    )
    told = rr.AnyValues(
        id=entity.id,
        kind=entity.kind.value,
        existence=entity.existence,
        affords=sorted(a for a in entity.affordances if entity.affords(a)),
        room=entity.room or "",
    )
    stream.log(f"map/{group}/{_part(entity.id)}", shown, told)


def _draw_past(stream: Any, whole: TopologicalMap) -> None:
    """Predictions that came to an end, as points for as long as they stood."""
    rr = rerun()
    for past in whole.past_predictions:
        path = f"map/past/{_part(past.id)}"
        label = f"{past.id}: {past.state.value}"
        stream.set_time(STAMPS, duration=past.first_seen)
        stream.log(path, rr.Points3D([past.position_xyz], colors=EXPECTED, labels=[label]))
        stream.set_time(STAMPS, duration=past.ended)
        stream.log(path, rr.Clear(recursive=False))


def _draw_way(stream: Any, whole: TopologicalMap) -> None:
    """The robot along its trajectory, and the places of the graph."""
    for row in whole.trajectory:
        stream.set_time(STAMPS, duration=float(row[0]))
        log_pose(stream, "map/robot", row[1:].reshape(4, 4))
    stream.reset_time()
    if whole.places:
        rr = rerun()
        points = [(p.x, p.y, 0.02) for p in whole.places]
        labels = [p.id for p in whole.places]
        shown = rr.Points3D(points, radii=0.06, colors=_WAY, labels=labels, show_labels=False)
        stream.log("map/places", shown, static=True)


def log_pose(stream: Any, path: str, T: np.ndarray[Any, Any]) -> None:
    """Log a pose (4, 4) with its axes, m."""
    rr = rerun()
    stream.log(path, rr.Transform3D(translation=T[:3, 3], mat3x3=T[:3, :3]))
    arrow = rr.Arrows3D(origins=[(0, 0, 0.1)], vectors=[(0.3, 0, 0)], colors=_WAY)
    stream.log(f"{path}/ahead", arrow)


def _about_z(yaw: float) -> tuple[float, float, float, float]:
    """The quaternion (x, y, z, w) of a turn about z, rad."""
    return 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)


def _part(id_: str) -> str:
    """An id as one part of an entity's path."""
    return str(rerun().escape_entity_path_part(id_))
