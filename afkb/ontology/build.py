"""Builds the ontology from its tables: one table, one kind of individual."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from rdflib import BNode, Graph, Literal, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS, SKOS, XSD

from afkb.errors import KnowledgeError
from afkb.ontology.header import PREFIXES, add_external_terms, add_header
from afkb.ontology.names import AFN, SOMETHING_ELSE
from afkb.ontology.rdfxml import to_rdfxml
from afkb.ontology.tables import Row, read_table

_TEXT = {
    "label": RDFS.label,
    "definition": SKOS.definition,
    "note": SKOS.note,
    "grounding": URIRef(AFN + "grounding"),
    "source": DCTERMS.source,
}
_PLAIN = {"status", "grounding_status", "observability", "stands_on", "parameter_name", "relation"}
_REFERENCES = {
    "broader": SKOS.broader,
    "category": URIRef(AFN + "ofCategory"),
    "feature": URIRef(AFN + "ofFeature"),
    "room": URIRef(AFN + "ofRoom"),
}
_NAMED = {
    "scale", "predicted_scale", "movability", "evidence", "predicted",
    "evidence_category", "predicted_category", "predicted_class",
}  # fmt: skip
_KINDS = {
    "structural": "StructuralAffordance",
    "material": "MaterialAffordance",
    "grasp": "GraspAffordance",
}
_STRONG = 0.9
"""Afbits at least this strong are necessary conditions of the entity class."""


@dataclass(frozen=True, slots=True)
class _Table:
    """How a table's rows become individuals; `parts` name one that has no name of its own."""

    name: str
    class_name: str
    definition: str = "{label}."
    parts: tuple[str, ...] = ()
    references: dict[str, str] = field(default_factory=dict)


_TABLES = (
    _Table("features", ""),
    _Table("trapezoids", "Trapezoid", parts=("feature", "parameter_name")),
    _Table("scales", "Scale"),
    _Table("category_groups", "CategoryGroup"),
    _Table("categories", "ObjectCategory", "The category of each {label}, at {scale} scale."),
    _Table("afbits", "Afbit", parts=("category", "feature")),
    _Table("duals", "Dual"),
    _Table("evidence_classes", "EvidenceClass"),
    _Table("co_occurrences", "CoOccurrence", references={"evidence_class": f"{AFN}evidenceClass"}),
    _Table("rooms", "RoomCategory"),
    _Table(
        "room_evidence",
        "RoomEvidence",
        parts=("room", "evidence_class"),
        references={"evidence_class": f"{AFN}ofEvidenceClass"},
    ),
    _Table("parameters", "NetworkParameter"),
)


def build_ontology(tables: Path) -> Graph:
    """The ontology as a graph, from a folder of tables; `KnowledgeError` with file and line."""
    graph = Graph()
    add_header(graph)
    add_external_terms(graph)
    for row in read_table(tables, "vocabulary"):
        _add_term(graph, row)
    for table in _TABLES:
        for row in read_table(tables, table.name):
            _add_individual(graph, table, row)
    _add_entity_classes(graph, read_table(tables, "categories"), read_table(tables, "afbits"))
    _add_group_classes(graph, read_table(tables, "category_groups"))
    _check_references(graph)
    return graph


def write_ontology(tables: Path, out: Path) -> int:
    """Build the ontology and write it as RDF/XML, the same bytes for the same tables.

    Returns the number of statements.
    """
    graph = build_ontology(tables)
    out.write_text(to_rdfxml(graph, PREFIXES), encoding="utf-8")
    return len(graph)


def _add_term(graph: Graph, row: Row) -> None:
    subject = URIRef(AFN + row["name"])
    kinds = {
        "class": OWL.Class,
        "object": OWL.ObjectProperty,
        "data": OWL.DatatypeProperty,
        "annotation": OWL.AnnotationProperty,
        "individual": OWL.NamedIndividual,
    }
    if row["kind"] not in kinds:
        raise KnowledgeError(f"{row.place}: kind {row['kind']!r} is none of: {', '.join(kinds)}")
    graph.add((subject, RDF.type, kinds[row["kind"]]))
    link = RDF.type if row["kind"] == "individual" else RDFS.subClassOf
    for parent in _split(row.get("parent")):
        graph.add((subject, link, URIRef(AFN + parent)))
    if row.get("domain"):
        graph.add((subject, RDFS.domain, URIRef(AFN + row["domain"])))
    if row.get("range"):
        base = XSD if row["kind"] == "data" else AFN
        graph.add((subject, RDFS.range, URIRef(str(base) + row["range"])))
    graph.add((subject, RDFS.label, Literal(row["label"], lang="en")))
    graph.add((subject, SKOS.definition, Literal(row["definition"], lang="en")))
    graph.add((subject, RDFS.comment, Literal(row["definition"], lang="en")))


def _add_individual(graph: Graph, table: _Table, row: Row) -> None:
    name = ".".join(row[part] for part in table.parts) if table.parts else row["name"]
    subject = URIRef(AFN + name)
    if (subject, RDF.type, OWL.NamedIndividual) in graph:
        raise KnowledgeError(f"{row.place}: {name} is stated a second time; keep one")
    graph.add((subject, RDF.type, OWL.NamedIndividual))
    graph.add((subject, RDF.type, URIRef(AFN + (table.class_name or _KINDS[row["kind"]]))))
    for predicate, value in _statements(table, row):
        graph.add((subject, predicate, value))
    if table.parts:
        label = Literal(": ".join(row[part] for part in table.parts), lang="en")
        graph.add((subject, RDFS.label, label))
    elif not row.get("definition"):
        text = table.definition.format_map(row.cells)
        graph.add((subject, SKOS.definition, Literal(text[0].upper() + text[1:], lang="en")))


def _statements(table: _Table, row: Row) -> Iterator[tuple[URIRef, URIRef | Literal]]:
    for column, cell in row.cells.items():
        if column in table.references:
            yield URIRef(table.references[column]), URIRef(AFN + cell)
        elif column in _TEXT:
            yield _TEXT[column], Literal(cell, lang="en")
        elif column == "examples":
            yield from ((SKOS.example, Literal(e, lang="en")) for e in _split(cell))
        elif column in _PLAIN:
            yield property_of(column), Literal(cell, datatype=XSD.string)
        elif column in _REFERENCES:
            yield _REFERENCES[column], URIRef(AFN + cell)
        elif column in _NAMED:
            yield property_of(column), URIRef(AFN + cell)
        elif column not in ("name", "kind"):
            yield property_of(column), Literal(repr(row.number(column)), datatype=XSD.double)


def property_of(column: str) -> URIRef:
    """The property that a column states: `length_min_m` states `afn:lengthMin`, in metres."""
    head, *rest = re.sub(r"_m$", "", column).split("_")
    return URIRef(AFN + head + "".join(part.capitalize() for part in rest))


def _add_entity_classes(graph: Graph, categories: list[Row], afbits: list[Row]) -> None:
    for row in categories:
        if row["name"] == SOMETHING_ELSE:
            continue
        parent = f"{row['broader']}Entity" if row.get("broader") else "Entity"
        entity_class = _add_class(graph, row, parent)
        for afbit in afbits:
            if afbit["category"] == row["name"] and afbit.number("strength") >= _STRONG:
                restriction = BNode(f"{row['name']}.{afbit['feature']}")
                graph.add((entity_class, RDFS.subClassOf, restriction))
                graph.add((restriction, RDF.type, OWL.Restriction))
                graph.add((restriction, OWL.onProperty, URIRef(AFN + "affords")))
                graph.add((restriction, OWL.hasValue, URIRef(AFN + afbit["feature"])))


def _add_group_classes(graph: Graph, groups: list[Row]) -> None:
    for row in groups:
        _add_class(graph, row, "Entity")


def _add_class(graph: Graph, row: Row, parent: str) -> URIRef:
    entity_class = URIRef(f"{AFN}{row['name']}Entity")
    definition = Literal(f"The things of the map that are each a {row['label']}.", lang="en")
    graph.add((entity_class, RDF.type, OWL.Class))
    graph.add((entity_class, RDFS.subClassOf, URIRef(AFN + parent)))
    graph.add((entity_class, RDFS.label, Literal(f"{row['label']} (entity)", lang="en")))
    graph.add((entity_class, SKOS.definition, definition))
    graph.add((URIRef(AFN + row["name"]), URIRef(AFN + "entityClass"), entity_class))
    return entity_class


def _check_references(graph: Graph) -> None:
    known = set(graph.subjects())
    for subject, predicate, value in sorted(graph):
        if isinstance(value, URIRef) and str(value).startswith(AFN) and value not in known:
            raise KnowledgeError(
                f"{str(subject).removeprefix(AFN)}: {predicate} names {value}, which no table has"
            )
        if str(predicate).startswith(AFN) and predicate not in known:
            raise KnowledgeError(
                f"{str(predicate).removeprefix(AFN)}: no such property in vocabulary.csv"
            )


def _split(cell: str) -> list[str]:
    return [part for part in cell.split("|") if part]
