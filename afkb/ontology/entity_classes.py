"""The OWL classes that classify a map's entities, one per category and per group (DESIGN §7)."""

from __future__ import annotations

from collections.abc import Iterable

from rdflib import BNode, Graph, Literal, URIRef
from rdflib.namespace import OWL, RDF, RDFS, SKOS

from afkb.csv_rows import Row
from afkb.ontology.names import AFN, BUNDLED, SOMETHING_ELSE, Names

STRONG = 0.9
"""Afbits of the whole thing at least this strong are necessary conditions of the class."""


def add_entity_classes(
    graph: Graph,
    categories: Iterable[Row],
    groups: Iterable[Row],
    afbits: Iterable[Row],
    names: Names = BUNDLED,
) -> None:
    """Add `afn:MugEntity` and its like, below each other as their categories are.

    A class has a restriction for each strong structural afbit of the whole thing: whatever is a
    table affords support.
    """
    for row in groups:
        _add_class(graph, row, "Entity", names)
    strong: dict[str, list[str]] = {}
    for afbit in afbits:
        if afbit.number("strength") >= STRONG:
            strong.setdefault(afbit["category"], []).append(afbit["feature"])
    for row in categories:
        if row["name"] == SOMETHING_ELSE:
            continue
        entity_class = _add_class(graph, row, class_name(row.get("broader")), names)
        for feature in sorted(set(strong.get(row["name"], []))):
            restriction = BNode(f"{row['name']}.{feature}")
            graph.add((entity_class, RDFS.subClassOf, restriction))
            graph.add((restriction, RDF.type, OWL.Restriction))
            graph.add((restriction, OWL.onProperty, URIRef(AFN + "affords")))
            graph.add((restriction, OWL.hasValue, URIRef(names.iri(feature))))


def class_name(category: str) -> str:
    """Name of the class of a category's entities; of everything, where there is no category."""
    return f"{category}Entity" if category else "Entity"


def _add_class(graph: Graph, row: Row, parent: str, names: Names) -> URIRef:
    entity_class = URIRef(names.new(class_name(row["name"])))
    definition = f"The things of a map that are of the category: {row['label']}."
    graph.add((entity_class, RDF.type, OWL.Class))
    graph.add((entity_class, RDFS.subClassOf, URIRef(names.iri(parent))))
    graph.add((entity_class, RDFS.label, Literal(f"{row['label']} (entity)", lang="en")))
    graph.add((entity_class, SKOS.definition, Literal(definition, lang="en")))
    example = row.get("example") or f"one {row['label']} of a map"
    graph.add((entity_class, SKOS.example, Literal(example, lang="en")))
    graph.add((URIRef(names.new(row["name"])), URIRef(AFN + "entityClass"), entity_class))
    return entity_class
