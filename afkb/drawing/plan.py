"""The plan of a map as SVG: a group per layer, in the paper's colours."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from afkb.drawing import svg as d
from afkb.drawing.layers import bounds, doorways, driven, edges, occupancy, places, rooms
from afkb.drawing.things import ids, past, things
from afkb.drawing.words import best
from afkb.flow import TopologicalMap

_MARGIN_M = 0.5
_LEAST_EXTENT_M = 5.0
_NODE_SHARE = 0.008
"""Radius of a support's circle as a share of the plan's longer side."""


def plan(topological_map: TopologicalMap) -> str:
    """The plan as one `<svg>`: tooltips on everything, `data-id` on every node.

    Nothing in it needs a script or an inline style, so a page with a strict content security
    policy can show it. Its past predictions are there to be shown when time is turned back.
    """
    west, south, east, north = _extent(topological_map)
    extent = max(east - west, north - south)
    radius = _NODE_SHARE * max(extent, _LEAST_EXTENT_M)
    layers = {
        "grid": occupancy(topological_map.grid),
        "rooms": rooms(topological_map),
        "bounds": bounds(topological_map),
        "doorways": doorways(topological_map),
        "path": (*driven(topological_map), *places(topological_map, radius)),
        "edges": edges(topological_map),
        "past": past(topological_map, radius),
        "things": things(topological_map, radius),
        "labels": _labels(topological_map, radius),
        "ids": ids(topological_map, radius),
    }
    groups = "\n".join(d.group(name, drawn) for name, drawn in layers.items())
    corner = f"{d.number(west)} {d.number(-north)}"
    view = f"{corner} {d.number(east - west)} {d.number(north - south)}"
    size = d.number(1.6 * radius)
    return (
        f'<svg class="plan hide-edges hide-ids" viewBox="{view}" font-size="{size}" role="img" '
        f'aria-label="Plan of the map">\n{groups}\n{_scale_bar(west, south, extent)}\n</svg>'
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


def _labels(m: TopologicalMap, radius: float) -> Iterator[str]:
    for room in m.rooms:
        name, p = best(room.belief, 1)[0] if room.belief else ("", 0.0)
        yield d.text("room-label", room.x, room.y, f"{name} {p:.2f}", room.id)
    for place in m.places:
        yield d.text("label", place.x, place.y + 1.3 * radius, place.id, place.id)


def _scale_bar(west: float, south: float, extent: float) -> str:
    """A bar of 1, 2, 5 or 10 m, at most a sixth of the plan, in its lower left corner."""
    length = max((m for m in (1, 2, 5, 10) if m <= extent / 6), default=1)
    x, y = west + 0.02 * extent, south + 0.02 * extent
    bar = d.line("ruler", (x, y), (x + length, y))
    name = d.text("label", x + length / 2, y + 0.006 * extent, f"{length} m")
    return d.group("scale", [bar, name])
