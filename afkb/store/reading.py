"""A map's graph read back from its RDF: the inverse of `afkb.store.scene`.

Numbers come back as they were written (0.1 mm, 1e-4 rad, probabilities to 1e-9), names in natural
order, since RDF keeps none. Not in the RDF, and so not read: the grid and the trajectory, which are
files beside it, loops that were considered, and categories beyond the likeliest eight.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from afkb.errors import MapError
from afkb.flow import (
    Bound,
    Closure,
    Doorway,
    Edge,
    EdgeKind,
    Entity,
    NodeKind,
    PastPrediction,
    RobotPlace,
    Room,
)
from afkb.store.facts import Facts, Thing
from afkb.store.reading_things import entity_of, makers, past_of
from afkb.store.stored import StoredMap

THINGS = (NodeKind.OBSERVED, NodeKind.DUAL, NodeKind.CO_OCCURRENCE)


@dataclass(frozen=True, slots=True, eq=False)
class SceneGraph:
    """What a scene's RDF tells of a `TopologicalMap`, under the same names."""

    places: tuple[RobotPlace, ...]
    entities: tuple[Entity, ...]
    bounds: tuple[Bound, ...]
    doorways: tuple[Doorway, ...]
    rooms: tuple[Room, ...]
    edges: tuple[Edge, ...]
    closures: tuple[Closure, ...]
    past_predictions: tuple[PastPrediction, ...]


def read_graph(stored: StoredMap) -> SceneGraph:
    """The map's nodes, rooms and edges; `MapError` where a statement can't be what afkb wrote."""
    facts = Facts(stored.store)
    try:
        past = tuple(map(past_of, facts.all("PastPrediction")))
        return SceneGraph(
            places=tuple(map(_place, facts.all(NodeKind.ROBOT_PLACE.value))),
            entities=tuple(entity_of(t, k) for k in THINGS for t in facts.all(k.value)),
            bounds=tuple(map(_bound, facts.all("Bound"))),
            doorways=tuple(map(_doorway, facts.all("Doorway"))),
            rooms=tuple(map(_room, facts.all("Room"))),
            edges=tuple(map(_edge, facts.all("Edge"))),
            closures=tuple(_closure(told, past) for told in facts.all("LoopClosure")),
            past_predictions=past,
        )
    except (ValueError, IndexError) as error:
        raise MapError(
            f"{stored.folder}: its scene has a value that no map has ({error}); map again"
        ) from error


def _place(told: Thing) -> RobotPlace:
    return RobotPlace(
        told.id,
        told.number("afn:x"),
        told.number("afn:y"),
        told.number("afn:yaw"),
        told.number("afn:firstSeen"),
        told.whole("afn:viewIndex"),
        told.name("afn:inRoom"),
    )


def _bound(told: Thing) -> Bound:
    start, end = told.outline()[:2]
    offset, turn = (told.maybe_number(f"afn:{of}Sigma") for of in ("offset", "yaw"))
    return Bound(
        id=told.id,
        start_xy=(start[0], start[1]),
        end_xy=(end[0], end[1]),
        observations=told.whole("afn:observations"),
        generated_by=makers(told),
        room=told.name("afn:inRoom"),
        sigmas=None if offset is None or turn is None else (offset, turn),
        existence=told.number("afn:existence", 1.0),
        first_seen=told.number("afn:firstSeen"),
        last_seen=told.number("afn:lastSeen"),
    )


def _doorway(told: Thing) -> Doorway:
    return Doorway(
        told.id,
        told.number("afn:x"),
        told.number("afn:y"),
        told.number("afn:yaw"),
        told.number("afn:width"),
        told.names("afn:connects"),
        told.number("afn:existence", 1.0),
    )


def _room(told: Thing) -> Room:
    other = told.name("afn:secondPurpose")
    second = (other, told.number("afn:secondPurposeProbability")) if other else None
    return Room(
        id=told.id,
        x=told.number("afn:x"),
        y=told.number("afn:y"),
        area=told.number("afn:area"),
        polygon_xy=np.array(told.outline(), dtype=np.float64).reshape(-1, 2),
        belief=told.belief("room", "roomCategory"),
        visited=told.flag("afn:visited"),
        connected_to=told.names("afn:connectedTo"),
        evidence={
            counted.name("afn:ofEvidenceClass") or "": counted.whole("rdf:value")
            for counted in told.things("afn:counted")
        },
        other_beliefs=_other_beliefs(told),
        second_purpose=second,
    )


def _other_beliefs(room: Thing) -> dict[str, dict[str, float]]:
    told: dict[str, list[tuple[float, str]]] = {}
    for belief in room.things("afn:otherRoomBelief"):
        p, name = belief.number("afn:probability"), belief.name("afn:roomCategory") or ""
        told.setdefault(makers(belief)[0], []).append((-p, name))
    return {by: {name: -p for p, name in sorted(found)} for by, found in sorted(told.items())}


def _edge(told: Thing) -> Edge:
    return Edge(
        id=told.id,
        kind=EdgeKind(told.name("afn:edgeKind") or ""),
        source=told.name("afn:from") or "",
        target=told.name("afn:to") or "",
        distance=told.number("afn:distance"),
        bearing=told.number("afn:bearing"),
        linkage_angle=told.maybe_number("afn:linkageAngle"),
    )


def _closure(told: Thing, past: Sequence[PastPrediction]) -> Closure:
    """A prediction that was seen; when it was made first, its life tells, which ended then."""
    entity, stamp = told.name("afn:confirms") or "", told.number("afn:lastSeen")
    lives = (p.first_seen for p in past if p.seen_as == entity and p.ended == stamp)
    return Closure(
        entity=entity,
        predicted_as=NodeKind(told.name("afn:predictedAs") or ""),
        predicted_probability=told.number("afn:probability"),
        displacement_m=told.number("afn:displacement"),
        place=told.name("afn:seenFrom") or "",
        stamp=stamp,
        predicted_stamp=next(lives, math.nan),
    )
