"""The JSON shapes of DESIGN §5, read from a stored map; docs/reference.md lists them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping

from pyoxigraph import NamedNode

from afkb.store.stored import StoredMap
from afkb.store.vocabulary import MAP_NODES, local_name

Json = dict[str, object]
CATEGORIES_SHOWN = 5


def node_json(stored: StoredMap, node: NamedNode, kind: str) -> Json:
    """A node of the graph, map frame, m and rad."""
    x, y, z = (round(stored.number(node, f"afn:{axis}"), 3) for axis in "xyz")
    categories = list(stored.belief(node, "category", "category").items())[:CATEGORIES_SHOWN]
    shape: Json = {
        "id": local_name(node.value),
        "kind": kind,
        "x": x,
        "y": y,
        "z": z,
        "size": [round(stored.number(node, f"afn:size{axis}"), 3) for axis in "XYZ"],
        "yaw": round(stored.number(node, "afn:yaw"), 4),
        "affords": stored.names(node, "afn:affords"),
        "existence": round(stored.number(node, "afn:existence", 1.0), 4),
        "category": {name: round(p, 4) for name, p in categories},
        "room": stored.name(node, "afn:inRoom"),
        "supported_by": stored.name(node, "afn:supportedBy"),
    }
    return shape | _more(stored, node, kind)


def _more(stored: StoredMap, node: NamedNode, kind: str) -> Json:
    """What is said of things and not of places, where it differs from the usual."""
    if kind == "RobotPlace":
        return {"stamp": stored.number(node, "afn:firstSeen")}
    more: Json = {
        "movability": stored.name(node, "afn:movability"),
        "matching_weight": round(stored.number(node, "afn:matchingWeight"), 4),
        "observations": int(stored.number(node, "afn:observations")),
    }
    for key, predicate in (("predicted_first", "afn:predictedFirst"), ("part_of", "afn:partOf")):
        if value := stored.name(node, predicate):
            more[key] = value
    if anchors := stored.names(node, "afn:predictedFrom"):
        more["predicted_from"] = anchors
    if state := stored.name(node, "afn:predictionState"):
        more["state"] = state
    if stored.name(node, "afn:extentKnown") == "false":
        more["extent_known"] = False
    return more


def nodes_json(stored: StoredMap, kinds: Iterable[str] = MAP_NODES) -> list[Json]:
    """Every node of those kinds, kind by kind, in order of id."""
    return [node_json(stored, node, kind) for kind in kinds for node in stored.instances(kind)]


def rooms_json(stored: StoredMap) -> list[Json]:
    """Rooms with their posterior (sums to 1), area in m², outline and a point inside."""
    return [
        {
            "id": local_name(room.value),
            "belief": stored.belief(room, "room", "roomCategory"),
            "area": round(stored.number(room, "afn:area"), 3),
            "polygon": stored.outline(room) or [],
            "x": round(stored.number(room, "afn:x"), 3),
            "y": round(stored.number(room, "afn:y"), 3),
            "visited": stored.name(room, "afn:visited") == "true",
            "second_purpose": _second_purpose(stored, room),
            "other_beliefs": _other_beliefs(stored, room),
        }
        for room in stored.instances("Room")
    ]


def _second_purpose(stored: StoredMap, room: NamedNode) -> Json | None:
    """Of an open plan that serves two purposes: the other one, and how likely it has one."""
    name = stored.name(room, "afn:secondPurpose")
    if name is None:
        return None
    probability = stored.number(room, "afn:secondPurposeProbability")
    return {"category": name, "probability": probability}


def _other_beliefs(stored: StoredMap, room: NamedNode) -> dict[str, dict[str, float]]:
    """By room classifier, what it makes of the room, the likeliest first."""
    told: dict[str, list[tuple[float, str]]] = {}
    for node in stored.values(room, "afn:otherRoomBelief"):
        if isinstance(node, NamedNode):
            by = (stored.name(node, "prov:wasGeneratedBy") or "").removeprefix("by-")
            name = stored.name(node, "afn:roomCategory") or ""
            p = stored.number(node, "afn:probability")
            told.setdefault(by, []).append((-p, name))
    return {by: {name: -p for p, name in sorted(belief)} for by, belief in sorted(told.items())}


def doorways_json(stored: StoredMap) -> list[Json]:
    """Doorways with their width (m) and the rooms on both sides."""
    return [
        {
            "id": local_name(door.value),
            **{axis: round(stored.number(door, f"afn:{axis}"), 3) for axis in "xy"},
            "yaw": round(stored.number(door, "afn:yaw"), 4),
            "width": round(stored.number(door, "afn:width"), 3),
            "rooms": stored.names(door, "afn:connects"),
        }
        for door in stored.instances("Doorway")
    ]


def closures_json(stored: StoredMap) -> list[Json]:
    """Loop closures: which node, predicted as what and how surely, how far off (m)."""
    return [
        {
            "node": stored.name(closure, "afn:confirms"),
            "predicted_as": stored.name(closure, "afn:predictedAs"),
            "probability": stored.number(closure, "afn:probability"),
            "displacement": stored.number(closure, "afn:displacement"),
            "seen_from": stored.name(closure, "afn:seenFrom"),
            "stamp": stored.number(closure, "afn:lastSeen"),
        }
        for closure in stored.instances("LoopClosure")
    ]


def past_predictions_json(stored: StoredMap) -> list[Json]:
    """Predictions that came to an end: as what, where (m), how probable, and what came of them."""
    return [
        {
            "id": local_name(past.value),
            "predicted_as": stored.name(past, "afn:predictedAs"),
            "state": stored.name(past, "afn:predictionState"),
            **{axis: round(stored.number(past, f"afn:{axis}"), 3) for axis in "xyz"},
            "affords": stored.names(past, "afn:expectedAffordance"),
            "probability": round(stored.number(past, "afn:probability"), 4),
            "seen_as": stored.name(past, "afn:confirmedBy"),
            "axioms": stored.names(past, "prov:wasDerivedFrom"),
        }
        for past in stored.instances("PastPrediction")
    ]


def info_json(stored: StoredMap) -> Json:
    """Everything `afkb info --json` prints."""
    return {
        "map": str(stored.folder),
        "kinds": stored.kinds,
        "counts": stored.counts,
        "nodes": nodes_json(stored),
        "closures": closures_json(stored),
        "past_predictions": past_predictions_json(stored),
        "notes": stored.notes,
    }


def map_json(stored: StoredMap) -> str:
    """The text of map.json: rooms → objects, one node a line."""
    objects = nodes_json(stored, [kind for kind in MAP_NODES if kind != "RobotPlace"])
    rooms = [room | {"objects": _in(objects, room["id"])} for room in rooms_json(stored)]
    known = {room["id"] for room in rooms}
    whole = {
        "rooms": rooms,
        "elsewhere": [thing for thing in objects if thing["room"] not in known],
        "places": nodes_json(stored, ["RobotPlace"]),
        "doorways": doorways_json(stored),
        "notes": stored.notes,
    }
    return _one_node_a_line(whole)


def _in(objects: list[Json], room: object) -> list[Json]:
    return [thing for thing in objects if thing["room"] == room]


def _one_node_a_line(whole: Mapping[str, object]) -> str:
    """Compact JSON with a line break before each node, so that a diff tells what changed."""
    compact = json.dumps(whole, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return compact.replace('{"id":', '\n{"id":') + "\n"
