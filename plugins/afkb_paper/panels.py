"""The panels of a sheet: the graph so far, the growing grid, and what a robot saw."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb.drawing import svg as d
from afkb.drawing.layers import bounds, doorways, driven, occupancy
from afkb.drawing.words import describe, role
from afkb.flow import EdgeKind, Entity, NodeKind, TopologicalMap, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Source
from afkb_mapping.perception import Perception
from afkb_mapping.run_record import Stages

Array = NDArray[np.float64]

MARGIN_M = 0.4
RADIUS_M = 0.13
"""Of a robot place's circle; a thing's is smaller."""
SEAT_TOPS_M = (0.28, 0.58)
"""Heights between which one sits or lies: the limits of the ontology's evidence classes."""
BED_M2 = 1.4
"""The least area of a single bed's top; a couch's seat is smaller."""
PICTURE_PX = 360
JPEG_QUALITY = 80


@dataclass(frozen=True, slots=True)
class Frame:
    """What part of the plane a sheet's panels show: west, south, east, north, m."""

    west: float
    south: float
    east: float
    north: float

    @classmethod
    def around(cls, found: TopologicalMap) -> Frame:
        """All that a map holds, with a margin."""
        ends = [end for b in found.bounds for end in (b.start_xy, b.end_xy)]
        points = [(p.x, p.y) for p in found.places] + [(x, y) for x, y in ends]
        points += [e.position_xyz[:2] for e in found.entities]
        return cls.of([np.array(points or [(0.0, 0.0)])])

    @classmethod
    def of(cls, points_xy: Sequence[Array]) -> Frame:
        """All of these points, each (N, 2) m, with a margin."""
        corners = np.concatenate(points_xy)
        low, high = corners.min(axis=0) - MARGIN_M, corners.max(axis=0) + MARGIN_M
        return cls(float(low[0]), float(low[1]), float(high[0]), float(high[1]))

    def svg(self, title: str, parts: Iterator[str] | list[str]) -> str:
        """The parts as one picture; `title` says what it shows to who can't see it."""
        width, height = d.number(self.east - self.west), d.number(self.north - self.south)
        view = f"{d.number(self.west)} {d.number(-self.north)} {width} {height}"
        inside = "\n".join(parts)
        return f'<svg viewBox="{view}" role="img" aria-label="{title}">\n{inside}\n</svg>'


def graph_panel(found: TopologicalMap, frame: Frame) -> str:
    """Nodes so far, predicted ones hollow, and edges between places with their bearing."""
    parts = [*bounds(found), *doorways(found), *_edges(found), *_things(found), *_places(found)]
    return frame.svg("The graph so far", parts)


def grid_panel(found: TopologicalMap, frame: Frame) -> str:
    """The occupancy grid and the robot's way so far."""
    return frame.svg("The occupancy grid so far", [*occupancy(found.grid), *driven(found)])


def ways_panel(
    found: TopologicalMap, frame: Frame, ways: list[tuple[str, Array]], thing: Array | None = None
) -> str:
    """Ways, each of a CSS class, over the grid and the graph's things; and a true outline."""
    parts = [*occupancy(found.grid), *_things(found)]
    parts += [d.path("true", thing, True)] if thing is not None else []
    parts += [d.path(f"way {kind}", way, False) for kind, way in ways]
    return frame.svg("Ways on the map", parts)


def _edges(found: TopologicalMap) -> Iterator[str]:
    where = {p.id: (p.x, p.y) for p in found.places}
    things = {e.id: e.position_xyz[:2] for e in found.entities}
    for edge in found.edges:
        start, end = where.get(edge.source), (where | things).get(edge.target)
        if start is None or end is None:
            continue
        if edge.kind is EdgeKind.OBSTACLE:
            yield d.line("obstacle", start, end, f"{edge.distance:.2f} m")
        elif edge.kind is EdgeKind.PATH:
            yield d.line("path", start, end)
            x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
            turn = math.degrees(edge.bearing)
            yield d.text("bearing", x, y, f"{edge.distance:.1f} m {turn:.0f}°")


def _things(found: TopologicalMap) -> Iterator[str]:
    shown = [e for e in found.entities if e.top_m > SEAT_TOPS_M[0] or role(e) != "support"]
    for entity in sorted(shown, key=lambda e: -e.size_xyz[0] * e.size_xyz[1]):
        x, y, _ = entity.position_xyz
        kind = f"thing {cluster(entity)} {_how_known(entity)}"
        if entity.polygon_xy is not None and len(entity.polygon_xy) > 2:
            yield d.path(f"outline {kind}", entity.polygon_xy, True)
        yield d.circle(kind, x, y, 0.5 * RADIUS_M, describe(entity))
        if entity.kind is not NodeKind.OBSERVED:
            yield d.text("p", x, _north(entity) + 0.08, f"p {entity.existence:.2f}")


def _north(entity: Entity) -> float:
    """Where a thing's outline ends, y, m."""
    outline = entity.polygon_xy
    return entity.position_xyz[1] if outline is None else float(outline[:, 1].max())


def _places(found: TopologicalMap) -> Iterator[str]:
    for number, place in enumerate(found.places, start=1):
        yield d.ray("heading", (place.x, place.y, place.yaw), (0.0, 2.5 * RADIUS_M))
        yield d.circle("place", place.x, place.y, RADIUS_M, place.id)
        yield d.text("number", place.x, place.y - 0.06, str(number))


def cluster(entity: Entity) -> str:
    """What the paper colours alike: supports as tables, as seats, or as beds; and containers."""
    what = role(entity)
    if what != "support":
        return what
    low, high = SEAT_TOPS_M
    if not low <= entity.top_m < high:
        return "table"
    return "bed" if entity.size_xyz[0] * entity.size_xyz[1] >= BED_M2 else "seat"


def _how_known(entity: Entity) -> str:
    seen = "seen" if entity.kind is NodeKind.OBSERVED else "expected"
    return f"{seen} dynamic" if entity.movability == "Dynamic" else seen


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Shows views of a recording with what the detectors saw in them."""

    source: Source
    perception: Perception

    @classmethod
    def of(cls, host: PluginHost, uri: str) -> Camera:
        """Of a recording."""
        return cls(host.open_source(uri), Perception(host.detectors(()), Stages()))

    def picture(self, index: int, T_map_base: Array) -> str:
        """An `<img>` of a frame's depth and what was detected in it, taken at a pose (4, 4)."""
        import cv2

        from afkb_mapping.overlay import overlay

        view = next(iter(self.source.views(index, index + 1)), None)
        assert isinstance(view, View)  # It was mapped.
        placed = replace(view, T_map_base=T_map_base)
        drawn = overlay(placed, self.perception.detections(placed))
        size = PICTURE_PX, round(PICTURE_PX * drawn.shape[0] / drawn.shape[1])
        small = cv2.resize(drawn, size, interpolation=cv2.INTER_AREA)
        written = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1]
        data = base64.b64encode(written.tobytes()).decode()
        return (
            f'<img src="data:image/jpeg;base64,{data}" alt="What the robot saw in frame {index}">'
        )
