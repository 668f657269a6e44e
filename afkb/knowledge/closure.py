"""What follows from an ontology and a map, without Java: enough to ask for classes in SPARQL.

Two steps, so that the first can be kept. `close_ontology` adds what the ontology alone entails:
`rdfs:subClassOf` and `skos:broaderTransitive` through all levels. `classify` adds what a map then
entails: its things' classes, from the classes stated, from domains and ranges, and from the
definitions of classes by affordance, scale and height; and that what affords a feature affords the
broader ones. What was added is in graphs of its own, so that it can be told from what was stated.

Beside these, a thing whose likeliest category is more likely than not (`BELIEVED_FROM`) counts as
of that category's class: a convenience of queries and no entailment, hence a third graph.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from pyoxigraph import BlankNode, Literal, NamedNode, Quad, RdfFormat, Store

from afkb.knowledge.definitions import (
    AFFORDS,
    BROADER,
    SCALE,
    SUBCLASS,
    Definitions,
    ThingFacts,
    Z,
    links,
    upwards,
)
from afkb.ontology.names import AFN, RDF_TYPE, SKOS

INFERRED_GRAPH = "urn:afkb:inferred"
BELIEVED_GRAPH = "urn:afkb:believed"
BELIEVED_FROM = 0.5
"""A category more probable than this gives a thing its class; two can't be at once."""

_TYPE = NamedNode(RDF_TYPE)
_BROADER_TRANSITIVE = NamedNode(SKOS + "broaderTransitive")
_Node = NamedNode | BlankNode


def closed_ontology(store: Store) -> bytes:
    """An ontology's store and what follows from it, as N-Quads: load it in its place."""
    close_ontology(store)
    return store.dump(format=RdfFormat.N_QUADS) or b""


def close_ontology(store: Store) -> int:
    """Add what the ontology entails of its terms to the store; returns how many statements."""
    added = [
        *_transitive(store, SUBCLASS, SUBCLASS),
        *_transitive(store, BROADER, _BROADER_TRANSITIVE),
    ]
    store.bulk_extend(added)
    return len(added)


def _transitive(store: Store, step: NamedNode, whole: NamedNode) -> list[Quad]:
    steps = links(store, step)
    stated = {(s, v) for s, values in links(store, whole).items() for v in values}
    graph = NamedNode(INFERRED_GRAPH)
    return [
        Quad(NamedNode(subject), whole, NamedNode(above), graph)
        for subject in steps
        for above in upwards(subject, steps)
        if (subject, above) not in stated
    ]


def classify(store: Store, definitions: Definitions, graphs: Iterable[str]) -> int:
    """Add what follows for the things of the maps in these named graphs; returns how much.

    Linear in the maps' statements: each thing is looked at by itself.
    """
    added: list[Quad] = []
    for name in graphs:
        graph = NamedNode(name)
        things = _Things(store, definitions)
        for quad in store.quads_for_pattern(None, None, None, graph):
            things.take(quad)
        added += things.follow()
        added += _believed(store, definitions, graph, things)
    store.bulk_extend(added)
    return len(added)


class _Things:
    """The things of one map, with what is stated of them that classes depend on."""

    def __init__(self, store: Store, definitions: Definitions) -> None:
        self._store = store
        self._definitions = definitions
        self.types: dict[_Node, set[str]] = defaultdict(set)
        self._derived: dict[_Node, set[str]] = defaultdict(set)
        self._affords: dict[_Node, set[str]] = defaultdict(set)
        self._scales: dict[_Node, set[str]] = defaultdict(set)
        self._z: dict[_Node, list[float]] = defaultdict(list)

    def take(self, quad: Quad) -> None:
        """Note what a statement says."""
        subject, predicate, value = quad.subject, quad.predicate, quad.object
        if not isinstance(subject, NamedNode | BlankNode):
            return
        self._derived[subject].update(self._definitions.domains.get(predicate.value, ()))
        if isinstance(value, NamedNode):
            self._derived[value].update(self._definitions.ranges.get(predicate.value, ()))
            noted = {_TYPE: self.types, AFFORDS: self._affords, SCALE: self._scales}
            if predicate in noted:
                noted[predicate][subject].add(value.value)
        elif predicate == Z and isinstance(value, Literal):
            self._z[subject].append(float(value.value))

    def follow(self) -> Iterator[Quad]:
        """What follows, without what is stated, here or in the ontology."""
        for thing in sorted({*self.types, *self._derived, *self._affords}, key=str):
            before = self.types[thing] | self._affords[thing]
            self.types[thing], affords = self._closed(thing)
            for predicate, names in ((_TYPE, self.types[thing]), (AFFORDS, affords)):
                for name in sorted(names - before):
                    quad = Quad(thing, predicate, NamedNode(name), NamedNode(INFERRED_GRAPH))
                    if not self._is_stated(quad):
                        yield quad

    def _is_stated(self, quad: Quad) -> bool:
        same = self._store.quads_for_pattern(quad.subject, quad.predicate, quad.object, None)
        return next(same, None) is not None

    def _closed(self, thing: _Node) -> tuple[set[str], set[str]]:
        """All classes and affordances of a thing: again until nothing is new."""
        known = self._definitions
        facts = ThingFacts(
            self.types[thing] | self._derived[thing],
            set(self._affords[thing]),
            set(self._scales[thing]),
            {(z, z) for z in self._z[thing]},
        )
        before = -1
        while before != facts.count:
            before = facts.count
            facts.types.update(*(known.above.get(name, ()) for name in tuple(facts.types)))
            facts.affords.update(*(known.implied.get(name, ()) for name in facts.types))
            facts.affords.update(*(known.broader.get(name, ()) for name in tuple(facts.affords)))
            for definition in known.defined:
                definition.apply(facts)
        return facts.types, facts.affords


def _believed(
    store: Store, definitions: Definitions, graph: NamedNode, things: _Things
) -> Iterator[Quad]:
    """The class of each thing's likeliest category, and those above it, where it likely is one."""
    categories = dict(_pairs(store, "category", graph))
    for belief, probability in _pairs(store, "probability", graph):
        category = categories.get(belief)
        if category is None or float(probability) <= BELIEVED_FROM:
            continue
        classes = definitions.entity_classes.get(category, ())
        names = {*classes, *(a for name in classes for a in definitions.above.get(name, ()))}
        believers = store.quads_for_pattern(
            None, NamedNode(AFN + "categoryBelief"), NamedNode(belief), graph
        )
        for thing in [quad.subject for quad in believers]:
            if isinstance(thing, NamedNode | BlankNode):
                for name in sorted(names - things.types[thing]):
                    yield Quad(thing, _TYPE, NamedNode(name), NamedNode(BELIEVED_GRAPH))


def _pairs(store: Store, prop: str, graph: NamedNode) -> Iterator[tuple[str, str]]:
    for quad in store.quads_for_pattern(None, NamedNode(AFN + prop), None, graph):
        if isinstance(quad.subject, NamedNode) and isinstance(quad.object, NamedNode | Literal):
            yield quad.subject.value, quad.object.value
