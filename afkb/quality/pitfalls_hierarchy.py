"""Pitfalls of hierarchies: cycles, and what may and may not be both."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib.namespace import OWL, RDF, RDFS, SKOS

from afkb.quality.checked import Checked, short
from afkb.quality.pitfall import Found, above, in_order

_HIERARCHIES = (RDFS.subClassOf, RDFS.subPropertyOf, SKOS.broader)


def cycles(checked: Checked) -> Iterator[Found]:
    """P06: terms that are broader than themselves."""
    for predicate in _HIERARCHIES:
        for term in sorted(t for t in checked.own if (t, predicate, None) in checked.graph):
            if term in above(checked.graph, term, predicate):
                by = ", ".join(short(o) for o in in_order(checked.graph.objects(term, predicate)))
                what = f"is {short(predicate)} itself, by way of {by}"
                yield Found(term, what, "take one of the steps out")


def self_disjoint(checked: Checked) -> Iterator[Found]:
    """Classes that can have no instance: disjoint with themselves or a broader class."""
    graph = checked.graph
    pairs = [*graph.subject_objects(OWL.disjointWith), *graph.subject_objects(OWL.complementOf)]
    for one, other in pairs:
        for term, rest in ((one, other), (other, one)):
            if term in checked.own and rest in {term, *above(graph, term)}:
                what = f"is disjoint with {short(rest)}, which it is a kind of"
                yield Found(term, what, "take the disjointness or the subclass axiom out")


def no_disjointness(checked: Checked) -> Iterator[Found]:
    """P10: nothing says what can't be both, so that no contradiction can ever show."""
    graph = checked.graph
    said = (None, OWL.disjointWith, None) in graph or (
        None, RDF.type, OWL.AllDisjointClasses
    ) in graph  # fmt: skip
    if not said and checked.bundled:
        for ontology in graph.subjects(RDF.type, OWL.Ontology):
            yield Found(ontology, "no two classes are disjoint", "say which classes share nothing")
