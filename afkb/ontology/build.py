"""Builds the ontology from its tables and rules: one table, one kind of individual."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rdflib import Graph, URIRef

from afkb.errors import KnowledgeError
from afkb.ontology.afbits import DrawnAfbit, whole_afbits
from afkb.ontology.counted import counted_rows
from afkb.ontology.counted_pairs import counted_pairs
from afkb.ontology.entity_classes import add_entity_classes
from afkb.ontology.entity_definitions import EntityDefinition, add_definitions
from afkb.ontology.header import PREFIXES, add_external_terms, add_header
from afkb.ontology.links import check_links, link_files
from afkb.ontology.modules import add_modules, write_modules
from afkb.ontology.names import AFN
from afkb.ontology.rdfxml import to_rdfxml
from afkb.ontology.rule_examples import add_rule_examples
from afkb.ontology.schema import AFBITS, CO_OCCURRENCES, TABLES
from afkb.ontology.statements import FROM_ROW, add_disjointness, add_individual, add_term
from afkb.ontology.table_folder import Tables
from afkb.ontology.tables import by_name, read_table
from afkb.ontology.writing import one_writer, put_whole

if TYPE_CHECKING:
    from afkb.figures import Figures


def build_ontology(folder: Path) -> Graph:
    """The ontology as a graph, from a folder of tables; `KnowledgeError` with file and line."""
    tables = Tables.read(folder)
    graph = Graph("SimpleMemory")  # without contexts: twice as quick to fill
    add_header(graph)
    add_external_terms(graph)
    for row in tables.rows["vocabulary"]:
        add_term(graph, row)
    add_disjointness(graph, tables.rows["vocabulary"])
    for table in TABLES:
        for row in tables.rows[table.name]:
            add_individual(graph, table, row)
    admitted = [afbit for afbit in tables.afbits() if afbit.refusal() is None]
    rows = [afbit.row() for afbit in admitted]
    for row in rows:
        add_individual(graph, AFBITS, row)
    if tables.figures is not None:
        _add_counted(graph, tables, admitted, tables.figures)
    whole = whole_afbits(rows, tables.rows["parts"], tables.kinds)
    add_entity_classes(graph, tables.rows["categories"], tables.rows["category_groups"], whole)
    add_definitions(graph, map(EntityDefinition.read, tables.rows["entity_definitions"]))
    add_rule_examples(graph)
    add_modules(graph)
    check_links(graph, tables.rows["links"], tables.rows["units"])
    _check_references(graph)
    return graph


def _add_counted(graph: Graph, tables: Tables, afbits: list[DrawnAfbit], figures: Figures) -> None:
    """Add what was counted in homes."""
    for table, row in counted_rows(figures):
        add_individual(graph, table, row)
    categories = by_name(tables.rows["categories"])
    taken = set(by_name(tables.rows["co_occurrences"]))
    for row in counted_pairs(figures, categories, afbits, taken):
        add_individual(graph, CO_OCCURRENCES, row)


def write_ontology(tables: Path, out: Path, modules: Path | None = None) -> int:
    """Build the ontology and write it as RDF/XML, the same bytes for the same tables.

    `modules`: a folder for its modules, a file each. One process writes at a time, and readers
    meet the old file or the new. Returns the number of statements.
    """
    with one_writer(out):
        graph = build_ontology(tables)
        put_whole(out, to_rdfxml(graph, PREFIXES))
        if modules is not None:
            write_modules(graph, modules)
    return len(graph)


def write_alignments(tables: Path, folder: Path) -> list[Path]:
    """Write the alignments that are built from tables: with WordNet, Wikidata and QUDT."""
    folder.mkdir(parents=True, exist_ok=True)
    files = link_files(read_table(tables, "links"), read_table(tables, "units"))
    for name, text in files.items():
        put_whole(folder / name, text)
    return [folder / name for name in files]


def _check_references(graph: Graph) -> None:
    known = set(graph.subjects())
    unknown = sorted(
        statement
        for statement in graph
        if isinstance(statement[2], URIRef)
        and statement[2] not in known
        and str(statement[2]).startswith(AFN)
    )
    for subject, _, value in unknown:
        place = graph.value(subject, FROM_ROW) or str(subject).removeprefix(AFN)
        raise KnowledgeError(
            f"{place}: {str(value).removeprefix(AFN)} is named here, and no table has it; "
            "add it, or mend the name"
        )
