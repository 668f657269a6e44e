"""What the scene says of each kind of thing in a map."""

from __future__ import annotations

import numpy as np
from pyoxigraph import NamedNode

from afkb.flow import (
    Bound,
    Closure,
    Doorway,
    Edge,
    EdgeKind,
    Entity,
    LoopProposal,
    NodeKind,
    RobotPlace,
)
from afkb.store.evidence import describe_history, describe_sightings
from afkb.store.predictions import describe_life
from afkb.store.scribe import Scribe, polygon_wkt, ranked
from afkb.store.vocabulary import term

AFFORDS_FROM = 0.5
CATEGORIES_KEPT = 8


def describe_place(scribe: Scribe, place: RobotPlace) -> None:
    """A place of the robot (V_r), on the floor."""
    node = scribe.node(place.id)
    scribe.say(node, "rdf:type", term("afn:RobotPlace"), term("afn:MapNode"))
    _position(scribe, node, place.x, place.y, 0.0)
    scribe.say(node, "afn:yaw", float(place.yaw))
    scribe.say(node, "afn:firstSeen", float(place.stamp))
    scribe.say(node, "afn:viewIndex", place.view_index)
    scribe.say(node, "prov:wasGeneratedBy", scribe.node("run"))
    _in_room(scribe, node, place.room)


def describe_entity(scribe: Scribe, entity: Entity) -> None:
    """A thing, observed or predicted (V_ao, V_ap, V_ac)."""
    node = scribe.node(entity.id)
    scribe.say(node, "rdf:type", term(f"afn:{entity.kind.value}"), term("afn:MapNode"))
    _position(scribe, node, *entity.position_xyz)
    _box(scribe, node, entity)
    _beliefs(scribe, node, entity)
    _relations(scribe, node, entity)
    _provenance(scribe, node, entity)
    describe_life(scribe, node, entity.state, entity.region)


def _position(scribe: Scribe, node: NamedNode, x: float, y: float, z: float) -> None:
    for axis, value in zip("xyz", (x, y, z), strict=True):
        scribe.say(node, f"afn:{axis}", float(value))


def _in_room(scribe: Scribe, node: NamedNode, room: str | None) -> None:
    if room is not None:
        scribe.say(node, "afn:inRoom", scribe.node(room))


def _box(scribe: Scribe, node: NamedNode, entity: Entity) -> None:
    for axis, size in zip("XYZ", entity.size_xyz, strict=True):
        scribe.say(node, f"afn:size{axis}", float(size))
    scribe.say(node, "afn:topHeight", float(entity.top_m))
    scribe.say(node, "afn:yaw", float(entity.yaw))
    scribe.say(node, "afn:extentKnown", bool(entity.extent_known))
    if entity.extent_known and max(entity.size_xyz) > 0:
        width, depth, height = (float(size) for size in entity.size_xyz)
        scribe.say(node, "afn:scale", scribe.scale_of((width, depth, height)))
    if entity.polygon_xy is not None and len(entity.polygon_xy) > 1:
        scribe.geometry(node, polygon_wkt(entity.polygon_xy))


def _beliefs(scribe: Scribe, node: NamedNode, entity: Entity) -> None:
    affordances = ranked(entity.affordances)
    afforded = [name for name, p in affordances if p >= AFFORDS_FROM] or [
        name for name, _ in affordances[:1]
    ]
    scribe.say(node, "afn:affords", *(scribe.individual(name) for name in afforded))
    scribe.belief(node, "affordance", "affordance", affordances)
    scribe.belief(node, "category", "category", ranked(entity.category_belief, CATEGORIES_KEPT))
    scribe.probability(node, "afn:existence", entity.existence)
    scribe.probability(node, "afn:matchingWeight", entity.matching_weight)
    scribe.say(node, "afn:movability", term(f"afn:{entity.movability}"))


def _relations(scribe: Scribe, node: NamedNode, entity: Entity) -> None:
    _in_room(scribe, node, entity.room)
    for predicate, other in (
        ("afn:supportedBy", entity.supported_by),
        ("afn:partOf", entity.part_of),
    ):
        if other is not None:
            scribe.say(node, predicate, scribe.node(other))
    scribe.say(node, "afn:seenFrom", *map(scribe.node, entity.seen_from))
    scribe.say(node, "afn:predictedFrom", *map(scribe.node, entity.predicted_from))


def _provenance(scribe: Scribe, node: NamedNode, entity: Entity) -> None:
    scribe.say(node, "afn:observations", int(entity.observations))
    scribe.say(node, "afn:firstSeen", float(entity.first_seen))
    scribe.say(node, "afn:lastSeen", float(entity.last_seen))
    if entity.predicted_first is not None:
        scribe.say(node, "afn:predictedFirst", term(f"afn:{entity.predicted_first.value}"))
    scribe.say(node, "prov:wasGeneratedBy", scribe.node("run"))
    scribe.say(node, "prov:wasGeneratedBy", *scribe.makers(entity.generated_by))
    scribe.say(node, "prov:wasDerivedFrom", *map(scribe.axiom, entity.axioms))
    scribe.say(node, "prov:wasDerivedFrom", *map(scribe.node, entity.predicted_from))
    describe_sightings(scribe, node, entity.sightings)
    describe_history(scribe, node, entity.history)


def describe_bound(scribe: Scribe, bound: Bound) -> None:
    """A straight piece of wall: its middle, its length, and the line itself."""
    node = scribe.node(bound.id)
    ends = np.array([bound.start_xy, bound.end_xy], dtype=np.float64)
    (x, y), along = ends.mean(axis=0), ends[1] - ends[0]
    scribe.say(node, "rdf:type", term("afn:Bound"))
    _position(scribe, node, x, y, 0.0)
    scribe.say(node, "afn:length", float(np.hypot(*along)))
    scribe.say(node, "afn:yaw", float(np.arctan2(along[1], along[0])))
    scribe.say(node, "afn:observations", int(bound.observations))
    scribe.probability(node, "afn:existence", bound.existence)
    scribe.say(node, "afn:firstSeen", float(bound.first_seen))
    scribe.say(node, "afn:lastSeen", float(bound.last_seen))
    if bound.sigmas is not None:
        offset, turn = bound.sigmas
        scribe.say(node, "afn:offsetSigma", float(offset))
        scribe.say(node, "afn:yawSigma", float(turn))
    scribe.geometry(node, polygon_wkt(ends))
    scribe.say(node, "prov:wasGeneratedBy", *scribe.makers(bound.generated_by))
    _in_room(scribe, node, bound.room)


def describe_doorway(scribe: Scribe, doorway: Doorway) -> None:
    """A passage, and the rooms that are connected through it."""
    node = scribe.node(doorway.id)
    scribe.say(node, "rdf:type", term("afn:Doorway"))
    _position(scribe, node, doorway.x, doorway.y, 0.0)
    scribe.say(node, "afn:yaw", float(doorway.yaw))
    scribe.say(node, "afn:width", float(doorway.width))
    scribe.probability(node, "afn:existence", doorway.existence)
    rooms = [scribe.node(room) for room in doorway.rooms]
    scribe.say(node, "afn:connects", *rooms)
    for room in rooms:
        scribe.say(room, "afn:connectedTo", *(other for other in rooms if other != room))


def describe_edge(scribe: Scribe, edge: Edge) -> None:
    """An edge of the graph: a way between places, or a distance to an obstacle or bound."""
    node, source, target = map(scribe.node, (edge.id, edge.source, edge.target))
    scribe.say(node, "rdf:type", term("afn:Edge"))
    scribe.say(node, "afn:edgeKind", edge.kind.value)
    scribe.say(node, "afn:from", source)
    scribe.say(node, "afn:to", target)
    scribe.say(node, "afn:distance", float(edge.distance))
    scribe.say(node, "afn:bearing", float(edge.bearing))
    if edge.linkage_angle is not None:
        scribe.say(node, "afn:linkageAngle", float(edge.linkage_angle))
    scribe.say(source, "afn:connectedTo", target)
    if edge.kind is EdgeKind.PATH:
        scribe.say(target, "afn:connectedTo", source)


def describe_closure(scribe: Scribe, number: int, closure: Closure) -> None:
    """A prediction that was then seen: the paper's loop-closing event (Algorithm 1)."""
    node = scribe.node(f"closure-{number}")
    scribe.say(node, "rdf:type", term("afn:LoopClosure"))
    scribe.say(node, "afn:confirms", scribe.node(closure.entity))
    scribe.say(node, "afn:predictedAs", term(f"afn:{NodeKind(closure.predicted_as).value}"))
    scribe.probability(node, "afn:probability", closure.predicted_probability)
    scribe.say(node, "afn:displacement", float(closure.displacement_m))
    scribe.say(node, "afn:seenFrom", scribe.node(closure.place))
    scribe.say(node, "afn:lastSeen", float(closure.stamp))


def describe_correction(scribe: Scribe, number: int, loop: LoopProposal) -> None:
    """A place that was seen again, and by how much that corrected the robot's way."""
    node = scribe.node(f"loop-{number}")
    scribe.say(node, "rdf:type", term("afn:LoopCorrection"))
    scribe.say(node, "afn:recognisedBy", loop.kind.value)
    scribe.say(node, "afn:correction", float(loop.corrected_m))
    scribe.say(node, "afn:correctionAngle", float(loop.corrected_rad))
    scribe.say(node, "afn:seenFrom", scribe.node(loop.place))
    scribe.say(node, "afn:earlierPlace", scribe.node(loop.earlier_place))
    scribe.say(node, "afn:lastSeen", float(loop.stamp))
