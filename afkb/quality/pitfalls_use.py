"""Pitfalls of use: terms that nothing uses, and terms that are used and not declared."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import Graph, URIRef
from rdflib.namespace import OWL, RDF, RDFS
from rdflib.term import Node

from afkb.ontology.names import AFN
from afkb.quality.checked import Checked, short
from afkb.quality.pitfall import PROPERTIES, Found, above, classes_of, in_order, own_of

_USED_BY_STATEMENTS = (
    "StructuralAffordance", "MaterialAffordance", "GraspAffordance", "Scale", "Shape", "Material",
    "Trait", "ObjectPart", "Pose", "MovingHabit", "Movability", "CategoryGroup", "AfbitRule",
    "EvidenceClass",
)  # fmt: skip
"""Classes whose individuals are there for statements to name."""
_BUILT_IN = (str(OWL), str(RDF), str(RDFS), "http://www.w3.org/2001/XMLSchema#")


def orphans(checked: Checked) -> Iterator[Found]:
    """P04: classes and individuals that no statement names."""
    graph = checked.graph
    kinds = [URIRef(AFN + name) for name in _USED_BY_STATEMENTS]
    for term in own_of(checked, *kinds):
        if (None, None, term) not in graph and not _is_deprecated(graph, term):
            yield Found(term, "no statement names it", "use it, or take it out")
    for term in own_of(checked, OWL.Class):
        if (None, None, term) not in graph and (term, RDFS.subClassOf, None) not in graph:
            yield Found(term, "nothing is of this class", "use it, or take it out")


def _is_deprecated(graph: Graph, term: Node) -> bool:
    return str(graph.value(term, OWL.deprecated)) == "true"


def unused_properties(checked: Checked) -> Iterator[Found]:
    """Properties for what the ontology holds that nothing has.

    A property whose domain has no individual here is for maps, and fine.
    """
    graph = checked.graph
    used = set(graph.predicates()) | set(graph.objects(None, OWL.onProperty))
    for term in own_of(checked, *PROPERTIES):
        if term in used or any(p != OWL.onProperty for p in graph.predicates(None, term)):
            continue
        domain = graph.value(term, RDFS.domain)
        if domain is not None and _has_individuals(graph, domain):
            yield Found(term, "no statement uses it", "use it, or take it out")


def _has_individuals(graph: Graph, kind: Node) -> bool:
    below = {c for c in graph.subjects(RDF.type, OWL.Class) if kind in above(graph, c)}
    return any((None, RDF.type, c) in graph for c in (kind, *below))


def undeclared_classes(checked: Checked) -> Iterator[Found]:
    """P34: what stands where a class stands, and is declared nowhere."""
    graph = checked.graph
    places = ((RDF.type, False), (RDFS.subClassOf, True), (RDFS.domain, False),
              (OWL.equivalentClass, True), (OWL.disjointWith, True),
              (OWL.someValuesFrom, False))  # fmt: skip
    for predicate, subject_too in places:
        for subject, value in graph.subject_objects(predicate):
            for term in (subject, value) if subject_too else (value,):
                known = (term, RDF.type, OWL.Class) in graph or str(term).startswith(_BUILT_IN)
                if isinstance(term, URIRef) and not known and subject in checked.own:
                    what = f"{short(term)} is used as a class and not declared as one"
                    yield Found(subject, what, "declare it as owl:Class, or mend the name")


def undeclared_properties(checked: Checked) -> Iterator[Found]:
    """P35: predicates that are declared nowhere, slips of the pen among them."""
    graph = checked.graph
    declared = {p for kind in PROPERTIES for p in graph.subjects(RDF.type, kind)}
    unknown = {p for p in set(graph.predicates()) - declared if not str(p).startswith(_BUILT_IN)}
    for predicate in in_order(unknown):
        for subject in in_order(s for s in graph.subjects(predicate) if s in checked.own):
            what = f"{short(predicate)} is used as a property and not declared as one"
            yield Found(subject, what, "mend the name, or declare it")


def unknown_terms(checked: Checked) -> Iterator[Found]:
    """Names of this ontology, or of the checked files, that nothing states."""
    spaces = {AFN} | {str(t).rsplit("#", 1)[0] + "#" for t in checked.own if "#" in str(t)}
    for subject in sorted(checked.own):
        for predicate, value in checked.graph.predicate_objects(subject):
            is_ours = isinstance(value, URIRef) and str(value).startswith(tuple(spaces))
            if is_ours and (value, None, None) not in checked.graph:
                what = f"{short(predicate)} names {short(value)}, which nothing states"
                yield Found(subject, what, "mend the name, or state it")


def untyped(checked: Checked) -> Iterator[Found]:
    """Terms with statements and no class."""
    for term in sorted(checked.own):
        if not classes_of(checked.graph, term):
            yield Found(term, "is of no class", "say what it is by rdf:type")


def hijacked(checked: Checked) -> Iterator[Found]:
    """P40: more than a declaration said of a term that is others' to define."""
    for subject in sorted({s for s in checked.graph.subjects() if isinstance(s, URIRef)}):
        if subject in checked.own:
            continue
        said = set(checked.graph.predicates(subject)) - {RDF.type}
        if said and checked.bundled:
            what = f"{', '.join(short(p) for p in in_order(said))} is said of others' term"
            yield Found(subject, what, "leave it to those who define it")
