"""What the rows of an extension state, with the afbits that the rules make for them."""

from __future__ import annotations

from pathlib import Path

from rdflib import Graph, Literal, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS

from afkb.extensions.afbits import afbit_rows, own_afbits
from afkb.extensions.homes import home_rows
from afkb.extensions.sheet import Sheet, rows_of
from afkb.extensions.terms import Terms
from afkb.ontology.entity_classes import add_entity_classes
from afkb.ontology.names import Names
from afkb.ontology.schema import AFBITS
from afkb.ontology.statements import add_individual


def sheet_graph(sheet: Sheet, terms: Terms, tables: Path) -> Graph:
    """The statements of a sheet whose rows were checked and filled, entity classes among them.

    `terms`: all that are known, the sheet's own among them. `tables`: the folder with the rules.
    """
    names = names_in(sheet, terms)
    graph = Graph()
    _add_header(graph, sheet)
    for entry in sheet.entries:
        if entry.table is not AFBITS:
            add_individual(graph, entry.table, entry.row, names)
    afbits = afbit_rows(sheet, terms, tables)
    for row in afbits:
        add_individual(graph, AFBITS, row, names)
    for table, row in home_rows(sheet, terms, tables):
        add_individual(graph, table, row, names)
    wholes = own_afbits(afbits, sheet, terms, tables)
    categories, groups = sheet.of("categories"), sheet.of("category_groups")
    add_entity_classes(graph, rows_of(categories), rows_of(groups), wholes, names)
    return graph


def _add_header(graph: Graph, sheet: Sheet) -> None:
    ontology = URIRef(sheet.iri.rstrip("#/"))
    graph.add((ontology, RDF.type, OWL.Ontology))
    graph.add((ontology, RDFS.label, Literal(sheet.label, lang="en")))
    if sheet.license:
        graph.add((ontology, DCTERMS.license, URIRef(sheet.license)))
    if sheet.definition:
        graph.add((ontology, DCTERMS.description, Literal(sheet.definition, lang="en")))


def names_in(sheet: Sheet, terms: Terms) -> Names:
    """The IRIs of names, as the sheet means them."""
    return terms.resolver(sheet.iri, [e.name for e in sheet.entries if not e.table.parts])
