"""What a page tells of a node: its beliefs, and the evidence behind them, as plain data."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from afkb.drawing.words import best
from afkb.flow import (
    Change,
    Entity,
    NodeKind,
    PastPrediction,
    Region,
    RobotPlace,
    Room,
    Sighting,
    TopologicalMap,
)

Json = dict[str, object]
BELIEFS_TOLD = 5
LEAST_SHARE = 0.002
"""A square that a predicted thing is in less likely than this is not drawn."""


def facts_of(m: TopologicalMap) -> dict[str, Json]:
    """Id to the facts of every place, thing, room, doorway, bound and past prediction.

    Lengths in m, angles in rad, stamps in s on the map's clock, probabilities 0 to 1. Each has
    `kind`, the local name of its class; what is unknown or empty is left out.
    """
    told: dict[str, Json] = {place.id: _place(place) for place in m.places}
    told |= {entity.id: _entity(entity) for entity in m.entities}
    told |= {room.id: _room(room) for room in m.rooms}
    told |= {past.id: _past(past) for past in m.past_predictions}
    for door in m.doorways:
        across = {"width": _short(door.width), "rooms": list(door.rooms)}
        told[door.id] = _at("Doorway", door.x, door.y) | across | {"existence": door.existence}
    for bound in m.bounds:
        x, y = (sum(pair) / 2 for pair in zip(bound.start_xy, bound.end_xy, strict=True))
        known = {"existence": bound.existence, "observations": bound.observations}
        by: Json = {"room": bound.room, "by": list(bound.generated_by)}
        if bound.last_seen > 0:
            by |= {"first_seen": _short(bound.first_seen), "last_seen": _short(bound.last_seen)}
        told[bound.id] = _at("Bound", x, y) | known | by
    return {id_: _without_nothing(facts) for id_, facts in told.items()}


def _at(kind: str, x: float, y: float) -> Json:
    return {"kind": kind, "x": _short(x), "y": _short(y)}


def _short(value: float) -> float:
    return round(float(value), 3) + 0.0


def _belief(belief: Mapping[str, float]) -> dict[str, float]:
    return {name: round(float(p), 4) for name, p in best(belief, BELIEFS_TOLD)}


def _without_nothing(facts: Json) -> Json:
    return {k: v for k, v in facts.items() if v is not None and v not in ([], {}, "")}


def _place(place: RobotPlace) -> Json:
    seen = {"first_seen": _short(place.stamp), "view": place.view_index, "room": place.room}
    return _at(NodeKind.ROBOT_PLACE.value, place.x, place.y) | seen


def _room(room: Room) -> Json:
    return _at("Room", room.x, room.y) | {
        "rooms": list(room.connected_to),
        "belief": _belief(room.belief),
        "other_beliefs": {by: _belief(b) for by, b in sorted(room.other_beliefs.items())},
        "second_purpose": list(room.second_purpose) if room.second_purpose else None,
        "area": _short(room.area),
        "visited": room.visited,
        "evidence": {name: n for name, n in sorted(room.evidence.items()) if n},
    }


def _entity(entity: Entity) -> Json:
    x, y, z = entity.position_xyz
    return _at(entity.kind.value, x, y) | {
        "z": _short(z),
        "size": [_short(s) for s in entity.size_xyz],
        "extent_known": None if entity.extent_known else False,
        "affords": _belief(entity.affordances),
        "belief": _belief(entity.category_belief),
        "existence": round(float(entity.existence), 4),
        "movability": entity.movability,
        "room": entity.room,
        "on": entity.supported_by,
        "part_of": entity.part_of,
        "from": list(entity.predicted_from),
        "seen_from": list(entity.seen_from),
        "observations": entity.observations,
        "first_seen": _short(entity.first_seen),
        "last_seen": _short(entity.last_seen),
        "predicted_first": entity.predicted_first.value if entity.predicted_first else None,
        "state": entity.state.value if entity.state else None,
        "by": list(entity.generated_by),
        "axioms": [_local(axiom) for axiom in entity.axioms],
        "sightings": [_sighting(s) for s in entity.sightings],
        "steps": [_step(c) for c in entity.history],
        "region": _region(entity.region) if entity.region else None,
    }


def _past(past: PastPrediction) -> Json:
    x, y, z = past.position_xyz
    return _at("PastPrediction", x, y) | {
        "z": _short(z),
        "was": past.kind,
        "state": past.state.value,
        "affords": _belief(past.affordances),
        "existence": round(float(past.probability), 4),
        "seen_as": past.seen_as,
        "from": list(past.predicted_from),
        "first_seen": _short(past.first_seen),
        "ended": _short(past.ended),
        "by": [past.generated_by],
        "axioms": [_local(axiom) for axiom in past.axioms],
        "steps": [_step(c) for c in past.history],
    }


def _sighting(sighting: Sighting) -> Json:
    return {
        "view": sighting.view,
        "stamp": _short(sighting.stamp),
        "range": _short(sighting.range_m),
        "pixels": sighting.n_pixels,
        "box": list(sighting.image_box) if sighting.image_box else None,
        "by": list(sighting.detectors),
        "affords": _belief(sighting.affordances),
    }


def _step(change: Change) -> Json:
    return {
        "kind": change.kind.value,
        "stamp": _short(change.stamp),
        "view": change.view,
        "weighed": round(float(change.evidence), 4),
        "before": None if change.before is None else round(float(change.before), 4),
        "after": round(float(change.after), 4),
        "by": list(change.by),
    }


def _region(region: Region) -> Json:
    parts = region.parts[region.parts[:, 2] >= LEAST_SHARE]
    return {
        "relation": region.relation.value,
        "side": _short(region.part_m),
        "tops": [_short(top) for top in region.tops_m],
        "parts": np.round(parts, 4).tolist(),
    }


def _local(iri: str) -> str:
    return iri.rsplit("#" if "#" in iri else "/", 1)[-1]
