"""Rows of tables as statements about individuals."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import combinations

from rdflib import Graph, Literal, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS, SKOS, XSD

from afkb.csv_rows import Row
from afkb.ontology.names import AFN, BUNDLED, KINDS, Names
from afkb.ontology.schema import Table

FROM_ROW = URIRef(AFN + "fromRow")
"""Where a statement stands: file and line of its row."""


def add_individual(graph: Graph, table: Table, row: Row, names: Names = BUNDLED) -> URIRef:
    """Add what a row states; `KnowledgeError`, with its place, where its name is taken."""
    subject = URIRef(names.new(table.name_of(row)))
    earlier = graph.value(subject, FROM_ROW)
    if earlier is not None or (subject, RDF.type, None) in graph:
        where = f", after {earlier}" if earlier is not None else ""
        name = table.name_of(row)
        raise row.error(f"{name} is stated a second time{where}; keep one, or rename this one")
    graph.add((subject, RDF.type, OWL.NamedIndividual))
    graph.add((subject, RDF.type, URIRef(AFN + class_of(table, row))))
    graph.add((subject, FROM_ROW, Literal(row.place, datatype=XSD.string)))
    for predicate, value in table.statements(row, names):
        graph.add((subject, predicate, value))
    if table.parts and not row.get("label"):
        text = ": ".join(row.get(part) for part in table.parts if row.get(part))
        graph.add((subject, RDFS.label, Literal(text, lang="en")))
    return subject


def class_of(table: Table, row: Row) -> str:
    """Name of the class of the row's individual."""
    if table.class_name:
        return table.class_name
    if row["kind"] not in KINDS:
        raise row.error(f"kind {row['kind']!r} is none of: {', '.join(KINDS)}")
    return KINDS[row["kind"]]


_TERM_KINDS = {
    "class": OWL.Class,
    "object": OWL.ObjectProperty,
    "data": OWL.DatatypeProperty,
    "annotation": OWL.AnnotationProperty,
    "individual": OWL.NamedIndividual,
}


def add_term(graph: Graph, row: Row) -> None:
    """Add a class, property or vocabulary individual from a row of `vocabulary.csv`."""
    subject = URIRef(AFN + row["name"])
    if row["kind"] not in _TERM_KINDS:
        raise row.error(f"kind {row['kind']!r} is none of: {', '.join(_TERM_KINDS)}")
    graph.add((subject, RDF.type, _TERM_KINDS[row["kind"]]))
    graph.add((subject, FROM_ROW, Literal(row.place, datatype=XSD.string)))
    link = RDF.type if row["kind"] == "individual" else RDFS.subClassOf
    for parent in row.several("parent"):
        graph.add((subject, link, URIRef(AFN + parent)))
    for column, predicate in (("domain", RDFS.domain), ("range", RDFS.range)):
        if row.get(column):
            graph.add((subject, predicate, _class_named(row, column)))
    graph.add((subject, RDFS.label, Literal(row["label"], lang="en")))
    graph.add((subject, SKOS.definition, Literal(row["definition"], lang="en")))
    graph.add((subject, RDFS.comment, Literal(row["definition"], lang="en")))
    for example in row.several("example"):
        graph.add((subject, SKOS.example, Literal(example, lang="en")))
    graph.add((subject, URIRef(AFN + "status"), Literal("proposed", datatype=XSD.string)))
    graph.add((subject, DCTERMS.source, Literal(_source_of_term(row), lang="en")))


def _source_of_term(row: Row) -> str:
    """The vocabulary is this project's; where a definition cites the paper, so does the source."""
    cited = re.search(r"paper (§[^);]*|Fig[^);]*)", row["definition"])
    return f"vocabulary of this project{f', after {cited[0]}' if cited else ''}"


def _class_named(row: Row, column: str) -> URIRef:
    """A domain or range: `owl:Thing` where anything may be, a datatype, or a class."""
    if row[column] == "owl:Thing":
        return OWL.Thing
    literal = column == "range" and row["kind"] == "data"
    return URIRef((str(XSD) if literal else AFN) + row[column])


def add_disjointness(graph: Graph, rows: Iterable[Row]) -> None:
    """State that no two classes of a group in `vocabulary.csv` have an instance in common."""
    groups: dict[str, list[URIRef]] = {}
    for row in rows:
        for group in row.several("disjoint"):
            groups.setdefault(group, []).append(URIRef(AFN + row["name"]))
    for members in groups.values():
        for one, other in combinations(sorted(members), 2):
            graph.add((one, OWL.disjointWith, other))
