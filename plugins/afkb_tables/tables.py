"""The tables of a map: what each row is, what each column means."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from afkb.flow import Edge, Entity, PastPrediction, TopologicalMap
from afkb.store.scribe import polygon_wkt, ranked
from afkb_mapping.exporting.describing import (
    flat_bound,
    flat_doorway,
    flat_entity,
    flat_place,
    flat_room,
)

Row = Sequence[object]


@dataclass(frozen=True, slots=True)
class Column:
    """A column: its name, its Frictionless type, and what it says."""

    name: str
    type: str
    what: str


@dataclass(frozen=True, slots=True)
class Table:
    """A table; `key`: the column that names a row, if one does."""

    name: str
    what: str
    columns: Sequence[Column]
    rows: Sequence[Row]
    key: str | None = None


_WHAT = {
    "id": ("string", "name of the row, unique in the map"),
    "kind": ("string", "class of the node"),
    "x": ("number", "position in the map frame, m"),
    "y": ("number", "position in the map frame, m"),
    "z": ("number", "height above the floor, m: of what supports, of its upper surface"),
    "size_x": ("number", "length of its box along its own x axis, m"),
    "size_y": ("number", "length of its box along its own y axis, m"),
    "size_z": ("number", "height of its box, m"),
    "yaw": ("number", "direction in the map frame, rad"),
    "stamp": ("number", "when, s in the recording's clock"),
    "view_index": ("integer", "number of the view"),
    "category": ("string", "its likeliest category; all are in beliefs"),
    "category_probability": ("number", "of that category"),
    "affords": ("string", "affordances of at least 0.5; all are in beliefs"),
    "existence": ("number", "probability that it exists now"),
    "movability": ("string", "Static or Dynamic"),
    "matching_weight": ("number", "its weight when maps are matched, 0 to 1"),
    "observations": ("integer", "views that saw it, or implied it"),
    "first_seen": ("number", "s in the recording's clock"),
    "last_seen": ("number", "s in the recording's clock"),
    "extent_known": ("boolean", "whether the size is more than a lower bound"),
    "predicted": ("boolean", "whether it is expected and was not seen"),
    "room": ("string", "id of the room that it is in"),
    "supported_by": ("string", "id of what it stands on"),
    "part_of": ("string", "id of what it is a part of"),
    "state": ("string", "how a prediction stands"),
    "length": ("number", "m"),
    "width": ("number", "m"),
    "rooms": ("string", "ids of the rooms on both sides"),
    "area": ("number", "m²"),
    "visited": ("boolean", "whether the robot stood in it"),
    "outline": ("string", "seen from above, as well-known text in the map frame, m"),
    "node": ("string", "id of the node"),
    "about": ("string", "category, affordance, or room category"),
    "name": ("string", "what is believed"),
    "probability": ("number", "how surely, 0 to 1"),
    "source": ("string", "id of the node that it starts from"),
    "target": ("string", "id of the node that it leads to"),
    "distance": ("number", "m"),
    "bearing": ("number", "from source to target in the map frame, rad"),
    "linkage_angle": ("number", "the paper's E_t, rad"),
    "step": ("integer", "number of the step in its history"),
    "before": ("number", "probability before the step"),
    "after": ("number", "probability after the step"),
    "by": ("string", "ids of the things that spoke for it"),
    "view": ("integer", "number of the view that did it"),
}


def tables(whole: TopologicalMap) -> list[Table]:
    """All tables of a map, the nodes' first; rows are in the map's order."""
    places = [{"id": p.id, **flat_place(p)} for p in whole.places]
    things = [{"id": e.id, **flat_entity(e), "outline": _wkt(e.polygon_xy)} for e in whole.entities]
    rooms = [{"id": r.id, **flat_room(r), "outline": _wkt(r.polygon_xy)} for r in whole.rooms]
    bounds = [
        {"id": b.id, **flat_bound(b), "outline": _wkt([b.start_xy, b.end_xy])} for b in whole.bounds
    ]
    doorways = [{"id": d.id, **flat_doorway(d)} for d in whole.doorways]
    return [
        _table("places", "Places of the robot.", places, _PLACE),
        _table("things", "Things, seen and expected.", things, _THING),
        _table("rooms", "Rooms.", rooms, _ROOM),
        _table("bounds", "Straight pieces of wall.", bounds, _BOUND),
        _table("doorways", "Passages between rooms.", doorways, _DOORWAY),
        _table("edges", "Measured edges of the graph.", list(map(_edge, whole.edges)), _EDGE),
        _table("beliefs", "What is believed of nodes.", list(_beliefs(whole)), _BELIEF, key=None),
        _table("history", "How existences came about.", list(_history(whole)), _STEP, key=None),
    ]


_AT = ("x", "y", "z")
_PLACE = ("id", "kind", *_AT, "yaw", "stamp", "view_index", "room")
_THING = (
    *("id", "kind", "predicted", *_AT, "size_x", "size_y", "size_z", "yaw", "extent_known"),
    *("category", "category_probability", "affords", "existence", "movability", "matching_weight"),
    *("observations", "first_seen", "last_seen", "state", "room", "supported_by", "part_of"),
    "outline",
)
_ROOM = ("id", "x", "y", "area", "category", "category_probability", "visited", "outline")
_BOUND = (
    *("id", "x", "y", "length", "existence", "observations", "first_seen", "last_seen"),
    *("room", "outline"),
)
_DOORWAY = ("id", "x", "y", "yaw", "width", "existence", "rooms")
_EDGE = ("id", "kind", "source", "target", "distance", "bearing", "linkage_angle")
_BELIEF = ("node", "about", "name", "probability")
_STEP = ("node", "step", "kind", "before", "after", "stamp", "view", "by")


def _table(
    name: str, what: str, rows: Sequence[Any], columns: Sequence[str], key: str | None = "id"
) -> Table:
    told = [Column(column, *_WHAT[column]) for column in columns]
    return Table(name, what, told, [[row.get(c) for c in columns] for row in rows], key)


def _edge(edge: Edge) -> dict[str, object]:
    return {
        "id": edge.id,
        "kind": edge.kind.value,
        "source": edge.source,
        "target": edge.target,
        "distance": edge.distance,
        "bearing": edge.bearing,
        "linkage_angle": edge.linkage_angle,
    }


def _beliefs(whole: TopologicalMap) -> Iterator[dict[str, object]]:
    told = [(e.id, "category", e.category_belief) for e in whole.entities]
    told += [(e.id, "affordance", e.affordances) for e in whole.entities]
    told += [(r.id, "room category", r.belief) for r in whole.rooms]
    for node, about, belief in told:
        for name, p in ranked(belief):
            yield {"node": node, "about": about, "name": name, "probability": p}


def _history(whole: TopologicalMap) -> Iterator[dict[str, object]]:
    """The steps of what is there, and of predictions that came to an end."""
    nodes: tuple[Entity | PastPrediction, ...] = (*whole.entities, *whole.past_predictions)
    for node in nodes:
        for number, change in enumerate(node.history, start=1):
            yield {
                "node": node.id,
                "step": number,
                "kind": change.kind.value,
                "before": change.before,
                "after": change.after,
                "stamp": change.stamp,
                "view": change.view,
                "by": " ".join(change.by),
            }


def _wkt(outline: object) -> str | None:
    """Well-known text of an outline, or None where there is none."""
    points = np.asarray(outline if outline is not None else [], dtype=np.float64).reshape(-1, 2)
    return polygon_wkt(points) if len(points) > 1 else None
