"""What planning needs to know of a stored map: its nodes, rooms and ways, read from its RDF."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.finding import Surroundings
from afkb.store import StoredMap, load
from afkb.store.stored_grid import StoredGrid, read_grid
from afkb.store.vocabulary import local_name

Array = NDArray[np.float64]

THING_KINDS = ("ObservedEntity", "DualPrediction", "CoOccurrencePrediction")


@dataclass(frozen=True, slots=True, eq=False)
class Thing:
    """A thing, seen or expected: where, how surely, and what it may be; map frame, m."""

    id: str
    kind: str
    xy: Array
    polygon_xy: Array
    existence: float
    matching_weight: float
    belief: Mapping[str, float]
    room: str | None
    supported_by: str | None

    @property
    def seen(self) -> bool:
        """Whether it was seen, and not only expected."""
        return self.kind == "ObservedEntity"


@dataclass(frozen=True, slots=True, eq=False)
class Spot:
    """A robot place, a doorway, or a mere point: id, position (2,), m, and its room.

    Of a doorway also its `width`, m, and the direction through it, rad.
    """

    id: str
    xy: Array
    room: str | None = None
    width: float = 0.0
    yaw: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class MappedRoom:
    """A room with the posterior over what it is for; `xy` (2,) is a point inside, m."""

    id: str
    xy: Array
    belief: Mapping[str, float]
    visited: bool


@dataclass(frozen=True, slots=True, eq=False)
class RouteMap:
    """A map as routes see it; things, places, doorways and rooms by id.

    `surroundings`: the same map as finding sees it, which says where a thing may be.
    """

    grid: StoredGrid
    things: Mapping[str, Thing]
    places: Mapping[str, Spot]
    doorways: Mapping[str, Spot]
    rooms: Mapping[str, MappedRoom]
    surroundings: Surroundings = field(default_factory=Surroundings)

    @property
    def ids(self) -> set[str]:
        """Of everything that has one."""
        return {*self.things, *self.places, *self.doorways, *self.rooms}

    @classmethod
    def read(cls, folder: Path) -> RouteMap:
        """The map of a folder; raises `MapError` where there is none that can be read."""
        stored = load(folder)
        return cls(
            read_grid(folder),
            {t.id: t for kind in THING_KINDS for t in _things(stored, kind)},
            {s.id: s for s in _spots(stored, "RobotPlace")},
            {s.id: s for s in _spots(stored, "Doorway")},
            {r.id: r for r in _rooms(stored)},
            Surroundings.of(stored),
        )


def _things(stored: StoredMap, kind: str) -> list[Thing]:
    found = []
    for node in stored.instances(kind):
        belief = stored.belief(node, "category", "category")
        xy = np.array([stored.number(node, f"afn:{axis}") for axis in "xy"])
        outline = stored.outline(node)
        found.append(
            Thing(
                id=local_name(node.value),
                kind=kind,
                xy=xy,
                polygon_xy=np.array(outline) if outline else xy[None],
                existence=stored.number(node, "afn:existence", 1.0),
                matching_weight=stored.number(node, "afn:matchingWeight", 1.0),
                belief=belief,
                room=stored.name(node, "afn:inRoom"),
                supported_by=stored.name(node, "afn:supportedBy"),
            )
        )
    return found


def _spots(stored: StoredMap, kind: str) -> list[Spot]:
    return [
        Spot(
            local_name(node.value),
            np.array([stored.number(node, f"afn:{axis}") for axis in "xy"]),
            stored.name(node, "afn:inRoom"),
            stored.number(node, "afn:width"),
            stored.number(node, "afn:yaw"),
        )
        for node in stored.instances(kind)
    ]


def _rooms(stored: StoredMap) -> list[MappedRoom]:
    return [
        MappedRoom(
            local_name(node.value),
            np.array([stored.number(node, f"afn:{axis}") for axis in "xy"]),
            stored.belief(node, "room", "roomCategory"),
            stored.name(node, "afn:visited") == "true",
        )
        for node in stored.instances("Room")
    ]
