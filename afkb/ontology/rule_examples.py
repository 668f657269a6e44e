"""Examples of rules: for each the first afbit that it makes, in the notation of afbits."""

from __future__ import annotations

from rdflib import Graph, Literal, URIRef
from rdflib.namespace import RDF, RDFS, SKOS

from afkb.ontology.names import AFN


def add_rule_examples(graph: Graph) -> list[str]:
    """Give each rule an example; returns the names of rules that make no admitted afbit."""
    first: dict[str, str] = {}
    for afbit, rule in graph.subject_objects(URIRef(AFN + "byRule")):
        first[str(rule)] = min(first.get(str(rule), str(afbit)), str(afbit))
    idle = []
    for rule in graph.subjects(RDF.type, URIRef(AFN + "AfbitRule")):
        if (made := first.get(str(rule))) is None:
            idle.append(str(rule).removeprefix(AFN))
            continue
        label = graph.value(URIRef(made), RDFS.label)
        graph.add((URIRef(str(rule)), SKOS.example, Literal(str(label), lang="en")))
    return sorted(idle)
