"""Why a thing, a prediction or a room is held for what it is: all its chains together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pyoxigraph import NamedNode

from afkb.explaining.explanation import Explanation, Ground
from afkb.explaining.life import life_of
from afkb.explaining.purpose import purpose
from afkb.explaining.reading import (
    counts_by_room,
    counts_of,
    entities_of,
    entity_at,
    sightings_of,
)
from afkb.explaining.recognition import expectation, recognition
from afkb.explaining.source import Source, of_statement
from afkb.flow import Entity, NodeKind
from afkb.inference import Network
from afkb.inference.recognition import evidence_of, is_floor
from afkb.knowledge import AfNet
from afkb.knowledge.model import CoOccurrence, Dual
from afkb.store import StoredMap
from afkb.store.shapes import rooms_json
from afkb.store.vocabulary import local_name

ROUNDING = 1e-6
"""A recomputed probability that is further off than what the map rounds to is told of."""


def explain_thing(stored: StoredMap, node: NamedNode, network: Network) -> Explanation:
    """A thing that was seen: its sightings, its existence, and what it is."""
    entities = entities_of(stored)
    thing = entities[local_name(node.value)]
    facts = {
        "size": " × ".join(f"{v:.2f}" for v in thing.size_xyz) + " m",
        "its top": f"{thing.top_m:.2f} m above the floor",
        "affords": _probabilities(thing.affordances),
    }
    hints = thing.affordances.keys() - network.known(thing.affordances).keys()
    if hints:
        facts["of that no evidence of what it is"] = ", ".join(sorted(hints))
    if not thing.extent_known:
        facts["extent"] = "not known: at least as long and wide as it looks"
    told = f"seen, {_where(thing)}; held for {_probabilities(thing.category_belief, 3)}"
    explanation = Explanation(
        id=thing.id,
        kind="ObservedEntity",
        told=told,
        facts=facts,
        sightings=tuple(sightings_of(stored, node)),
        views=thing.observations,
        life=life_of(stored, node),
        grounds=tuple(_predicted_before(stored, node, network.knowledge_base)),
    )
    if is_floor(thing):
        note = "the lowest level surface, on which everything stands: no network infers that"
        return replace(explanation, notes=(note,))
    chain = recognition(network, thing, list(entities.values()), counts_by_room(stored))
    return replace(explanation, about="what it is", chain=chain)


def explain_prediction(
    stored: StoredMap, node: NamedNode, kind: str, network: Network
) -> Explanation:
    """A thing that is, or was, expected: what it follows from, by which axiom, and its life."""
    past = kind == "PastPrediction"
    state = stored.name(node, "afn:predictionState") or "Predicted"
    relation = stored.name(node, "afn:regionRelation") or ""
    expects = stored.names(node, "afn:expectedAffordance" if past else "afn:affords")
    seen_as = stored.name(node, "afn:confirmedBy")
    facts = {"state": state}
    if relation:
        facts["where"] = f"{relation} {' and '.join(stored.names(node, 'afn:predictedFrom'))}"
    if seen_as:
        facts["seen as"] = seen_as
    if past:
        facts["before its end"] = f"p = {stored.number(node, 'afn:probability'):.2f}"
    explanation = Explanation(
        id=local_name(node.value),
        kind=kind,
        told=f"expected, {'and seen' if seen_as else 'not seen'}: {' and '.join(expects)}",
        facts=facts,
        views=int(stored.number(node, "afn:observations")),
        life=life_of(stored, node, past),
        grounds=tuple(_follows_from(stored, node, network.knowledge_base)),
    )
    if past:
        return explanation
    thing = entity_at(stored, node, NodeKind(kind))
    chain = expectation(network, thing, relation)
    return replace(explanation, about="what it would be", chain=chain)


def explain_room(stored: StoredMap, node: NamedNode, network: Network) -> Explanation:
    """A room: what was counted in it, what counts, and what it is for."""
    id_ = local_name(node.value)
    things = [
        t
        for t in entities_of(stored).values()
        if t.room == id_ and t.kind is NodeKind.OBSERVED and not is_floor(t)
    ]
    counts, notes = counts_of(stored, node), []
    again = _counted_again(network, things)
    if again and not counts:
        notes.append("the map does not state what was counted; counted again, from its things")
        counts = again
    belief = stored.belief(node, "room", "roomCategory")
    counting = [
        Ground(t.id, f"counts as {' and '.join(classes)}")
        for t in things
        if (classes := evidence_of(t, network))
    ]
    visited = "stood in it" if stored.name(node, "afn:visited") == "true" else "looked into it"
    return Explanation(
        id=id_,
        kind="Room",
        told=f"a room, held for {_probabilities(belief, 3)}",
        facts={
            "area": f"{stored.number(node, 'afn:area'):.1f} m²",
            "the robot": visited,
            **_other_beliefs(stored, id_),
        },
        grounds=tuple(counting),
        about="what it is for",
        chain=purpose(network, counts, belief, things),
        notes=tuple(notes),
    )


def _other_beliefs(stored: StoredMap, room: str) -> dict[str, str]:
    """What stands beside the room's own belief: a second purpose, and what classifiers say."""
    told = next(r for r in rooms_json(stored) if r["id"] == room)
    found = {}
    if isinstance(second := told["second_purpose"], dict):
        found["a second purpose"] = f"{second['category']} {second['probability']:.2f}"
    if isinstance(others := told["other_beliefs"], dict):
        found |= {f"by {name}": _probabilities(belief, 3) for name, belief in others.items()}
    return found


def _counted_again(network: Network, things: Sequence[Entity]) -> dict[str, int]:
    found: dict[str, int] = {}
    for thing in things:
        for name in evidence_of(thing, network):
            found[name] = found.get(name, 0) + 1
    return found


def _where(thing: Entity) -> str:
    on = f"on {thing.supported_by}" if thing.supported_by else "on nothing that was seen"
    return f"{on}, in {thing.room or 'no room'}"


def _probabilities(found: object, count: int = 8) -> str:
    assert isinstance(found, dict)
    ranked = sorted(found.items(), key=lambda item: (-item[1], item[0]))[:count]
    return ", ".join(f"{name} {p:.2f}" for name, p in ranked)


def _predicted_before(stored: StoredMap, node: NamedNode, kb: AfNet) -> list[Ground]:
    """Of a thing whose prediction came true: what had predicted it."""
    first = stored.name(node, "afn:predictedFirst")
    if first is None:
        return []
    grounds = _follows_from(stored, node, kb)
    return [Ground(g.id, f"predicted it before it was seen: {g.how}", g.source) for g in grounds]


def _follows_from(stored: StoredMap, node: NamedNode, kb: AfNet) -> list[Ground]:
    """The axioms of a prediction, with their statements, and the nodes that it follows from."""
    anchors = stored.names(node, "afn:predictedFrom")
    derived = stored.names(node, "prov:wasDerivedFrom")
    found = [_axiom(kb, name) for name in derived if name not in anchors]
    return found + [Ground(name, "was seen") for name in anchors]


def _axiom(kb: AfNet, name: str) -> Ground:
    statements: dict[str, Dual | CoOccurrence] = {d.name: d for d in kb.duals}
    statements |= {c.name: c for c in kb.co_occurrences}
    stated = statements.get(name)
    if stated is None:
        return Ground(name, "the rule; no ontology in use states it")
    return Ground(name, f"the rule: {stated.label}", _source(stated))


def _source(stated: Dual | CoOccurrence) -> Source:
    if isinstance(stated, Dual):
        says = f"{stated.evidence} predicts {stated.predicted} {stated.relation} it"
    else:
        says = f"{stated.evidence_class} predicts {stated.predicted_class} near it"
    return of_statement(stated, f"{says} with strength {stated.strength:g}")
