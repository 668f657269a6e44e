"""The scene against DESIGN §7, statement by statement, for maps of many shapes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path

import rdflib
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from afkb.flow import Edge, EdgeKind, Entity, NodeKind
from afkb.store.scene import scene_base, scene_triples
from afkb.store.shapes import node_json
from afkb.store.stored import StoredMap, read_scene
from afkb.store.turtle import to_turtle
from afkb.store.vocabulary import AFN as AFN_IRI
from store_samples import Names, entity, sample_map

AFN = rdflib.Namespace(AFN_IRI)
KINDS = ("RobotPlace", "ObservedEntity", "DualPrediction", "CoOccurrencePrediction")
BELIEFS = {"affordance": "affordance", "category": "category", "room": "roomCategory"}

metres = st.floats(-1e4, 1e4)
lengths = st.floats(0, 50)
probabilities = st.floats(0, 1)
names = st.sampled_from(["SupportAbility", "ContainAbility", "Mug", "Hover ability", "n#1/Ü"])


@st.composite
def beliefs(draw: st.DrawFn) -> dict[str, float]:
    weights = draw(st.dictionaries(names, st.floats(0.01, 1), min_size=1, max_size=5))
    total = sum(weights.values())
    return {name: weight / total for name, weight in weights.items()}


@st.composite
def entities(draw: st.DrawFn) -> Entity:
    kind = draw(st.sampled_from([NodeKind.OBSERVED, NodeKind.DUAL, NodeKind.CO_OCCURRENCE]))
    return entity(
        draw(st.text(min_size=1, max_size=8).filter(lambda s: s.isprintable())),
        kind,
        position_xyz=draw(st.tuples(metres, metres, metres)),
        size_xyz=draw(st.tuples(lengths, lengths, lengths)),
        yaw=draw(st.floats(-math.pi, math.pi)),
        affordances=draw(st.dictionaries(names, probabilities, min_size=1)),
        category_belief=draw(beliefs()),
        existence=draw(probabilities),
        matching_weight=draw(probabilities),
        first_seen=draw(st.floats(0, 2e9)),
        predicted_from=() if kind is NodeKind.OBSERVED else ("n2",),
        extent_known=draw(st.booleans()),
    )


def written(things: tuple[Entity, ...]) -> bytes:
    edge = Edge("e1", EdgeKind.OBSTACLE, "p1", things[0].id, 0.0, 3.1)
    whole = dataclasses.replace(sample_map(), entities=things, closures=(), edges=(edge,))
    base = scene_base(whole, Names())
    return to_turtle(scene_triples(whole, base, Names()), base)


def breaches(graph: rdflib.Graph) -> Iterator[str]:
    def number(node: rdflib.term.Node, name: str) -> float:
        value = graph.value(node, AFN[name])
        return math.nan if value is None else float(value)

    yield from (f"blank {n}" for t in graph for n in t if isinstance(n, rdflib.BNode))
    for kind in KINDS:
        for node in graph.subjects(rdflib.RDF.type, AFN[kind]):
            if not all(math.isfinite(number(node, axis)) for axis in "xyz"):
                yield f"{node}: no place"
            if kind == "RobotPlace":
                continue
            existence = graph.value(node, AFN.existence)
            if not 0 <= float(existence) <= 1 or existence.datatype != rdflib.XSD.double:
                yield f"{node}: existence {existence}"
            for afforded in graph.objects(node, AFN.affords):
                if not str(afforded).startswith(AFN) and (afforded, None, None) not in graph:
                    yield f"{node}: affords {afforded}"
            needed = ["affords", "movability", "observations", "firstSeen", "lastSeen", "sizeX"]
            needed += ["seenFrom"] if kind == "ObservedEntity" else ["predictedFrom"]
            yield from (f"{node}: no {n}" for n in needed if graph.value(node, AFN[n]) is None)
    for kind, of in BELIEFS.items():
        for holder in set(graph.subjects(AFN[f"{kind}Belief"], None)):
            held = list(graph.objects(holder, AFN[f"{kind}Belief"]))
            total = sum(number(b, "probability") for b in held)
            if any(graph.value(b, AFN[of]) is None for b in held):
                yield f"{holder}: a {kind} belief in nothing"
            if (kind != "affordance" and total > 1 + 1e-6) or (kind == "room" and total < 0.999):
                yield f"{holder}: {kind} beliefs sum to {total}"
    for edge in graph.subjects(rdflib.RDF.type, AFN.Edge):
        if not number(edge, "distance") >= 0 or not math.isfinite(number(edge, "bearing")):
            yield f"{edge}: not measured"
        if not (graph.value(edge, AFN["from"]) and graph.value(edge, AFN.to)):
            yield f"{edge}: loose"


@given(entities())
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_map_meets_the_contract_and_reads_back(thing: Entity) -> None:
    turtle = written((thing,))
    assert list(breaches(rdflib.Graph().parse(data=turtle, format="turtle"))) == []
    stored = StoredMap(Path("m"), read_scene(turtle))
    (node,) = stored.instances(thing.kind.value)
    shape = node_json(stored, node, thing.kind.value)
    assert shape["id"] == thing.id
    assert all(abs(shape[a] - v) < 1e-3 for a, v in zip("xyz", thing.position_xyz, strict=True))
    assert abs(shape["existence"] - thing.existence) < 1e-3
    assert set(shape["affords"]) <= set(thing.affordances)
    assert shape.get("extent_known", True) is thing.extent_known


@given(st.permutations(range(4)))
@settings(max_examples=10, deadline=None)
def test_the_order_of_things_changes_no_byte(order: list[int]) -> None:
    things = [entity(f"n{i}", category_belief={"Mug": 0.5, "Bowl": 0.4}) for i in range(4)]
    shuffled = [things[i] for i in order]
    edge = Edge("e1", EdgeKind.OBSTACLE, "p1", "n0", 0.0, 3.1)
    texts = set()
    for listed in (things, shuffled):
        whole = dataclasses.replace(
            sample_map(), entities=tuple(listed), closures=(), edges=(edge,)
        )
        base = scene_base(whole, Names())
        texts.add(to_turtle(scene_triples(whole, base, Names()), base))
    assert len(texts) == 1
