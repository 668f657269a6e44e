"""What the searches for pitfalls share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rdflib import Graph, URIRef
from rdflib.namespace import OWL, RDF, RDFS
from rdflib.term import Node

from afkb.quality.checked import Checked

PROPERTIES = (OWL.ObjectProperty, OWL.DatatypeProperty, OWL.AnnotationProperty)


@dataclass(frozen=True, slots=True)
class Found:
    """A term that fell into a pitfall: what is wrong with it, how to mend it."""

    term: Node
    what: str
    mend: str


def own_of(checked: Checked, *kinds: Node) -> list[URIRef]:
    """The checked terms that are declared as one of these kinds, sorted."""
    graph = checked.graph
    found = {term for kind in kinds for term in graph.subjects(RDF.type, kind)}
    return sorted(URIRef(str(term)) for term in found if term in checked.own)


def classes_of(graph: Graph, term: Node) -> list[Node]:
    """The classes that a term is stated to be of, but for `owl:NamedIndividual`, sorted."""
    return in_order(c for c in graph.objects(term, RDF.type) if c != OWL.NamedIndividual)


def in_order(nodes: Iterable[Node]) -> list[Node]:
    """Terms and values sorted by their text."""
    return sorted(nodes, key=str)


def above(graph: Graph, term: Node, predicate: URIRef = RDFS.subClassOf) -> set[Node]:
    """All that is reached from a term over a predicate, the term itself only by a cycle."""
    found: set[Node] = set()
    waiting = list(graph.objects(term, predicate))
    while waiting:
        node = waiting.pop()
        if node not in found:
            found.add(node)
            waiting += graph.objects(node, predicate)
    return found


def twice(pairs: Iterable[tuple[object, URIRef]]) -> Iterator[tuple[URIRef, URIRef]]:
    """Each term whose key an earlier one has, with the earlier one."""
    first: dict[object, URIRef] = {}
    for key, term in pairs:
        if first.setdefault(key, term) != term:
            yield term, first[key]
