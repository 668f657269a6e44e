"""Says what a map knows of its rooms, in RDF: where, what for, and what that rests on."""

from __future__ import annotations

from collections.abc import Mapping

from pyoxigraph import NamedNode

from afkb.flow import Room
from afkb.store.scribe import Scribe, polygon_wkt, ranked
from afkb.store.vocabulary import escaped, term


def describe_room(scribe: Scribe, room: Room) -> None:
    """A room with a point inside, its outline, and the posterior over its purpose."""
    node = scribe.node(room.id)
    scribe.say(node, "rdf:type", term("afn:Room"), term("bot:Space"))
    scribe.say(node, "afn:x", float(room.x))
    scribe.say(node, "afn:y", float(room.y))
    scribe.say(node, "afn:area", float(room.area))
    scribe.say(node, "afn:visited", bool(room.visited))
    scribe.say(node, "afn:connectedTo", *map(scribe.node, room.connected_to))
    scribe.belief(node, "room", "roomCategory", ranked(room.belief))
    if room.second_purpose is not None:
        other, p = room.second_purpose
        scribe.say(node, "afn:secondPurpose", scribe.individual(other))
        scribe.probability(node, "afn:secondPurposeProbability", p)
    for classifier, belief in sorted(room.other_beliefs.items()):
        _other_belief(scribe, node, classifier, belief)
    for name, count in sorted(room.evidence.items()):
        counted = NamedNode(f"{node.value}-evidence-{escaped(name)}")
        scribe.say(node, "afn:counted", counted)
        scribe.say(counted, "afn:ofEvidenceClass", scribe.individual(name))
        scribe.say(counted, "rdf:value", int(count))
    if len(room.polygon_xy) > 1:
        scribe.geometry(node, polygon_wkt(room.polygon_xy))


def _other_belief(
    scribe: Scribe, room: NamedNode, classifier: str, belief: Mapping[str, float]
) -> None:
    """What a room classifier makes of a room, signed."""
    maker = scribe.node(f"by-{classifier}")
    scribe.say(maker, "rdf:type", term("prov:Activity"))
    scribe.say(maker, "rdfs:label", classifier)
    for name, p in ranked(belief):
        node = NamedNode(f"{room.value}-{escaped(classifier)}-{escaped(name)}")
        scribe.say(room, "afn:otherRoomBelief", node)
        scribe.say(node, "afn:roomCategory", scribe.individual(name))
        scribe.probability(node, "afn:probability", p)
        scribe.say(node, "prov:wasGeneratedBy", maker)
