"""Reads ontology files as the graph that the gates look at."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from pyoxigraph import BlankNode, NamedNode, Triple
from pyoxigraph import Literal as OxLiteral
from rdflib import BNode, Graph, Literal, URIRef
from rdflib.namespace import XSD
from rdflib.term import Node

from afkb.errors import KnowledgeError
from afkb.ontology.rdf_files import RDF_FORMATS, read_triples


def read_graphs(files: Sequence[Path]) -> dict[Path, Graph]:
    """What each file states: the ontology, then its extensions, in the order they are stacked.

    `KnowledgeError`, with file and line, where one can't be read.
    """
    stacked: dict[Path, Graph] = {}
    if any(path.suffix not in RDF_FORMATS for path in files):
        from afkb.extensions import read_stack

        stacked = read_stack(files)
    # The last first: a slip in an extension is told before the large ontology is read.
    read = {p: plain(stacked[p]) if p in stacked else read_graph(p) for p in reversed(files)}
    return {path: read[path] for path in files}


def read_graph(path: Path) -> Graph:
    """What a file of RDF states; `KnowledgeError`, with file and line, where it can't be read.

    Plain and `xsd:string` literals come out alike, as RDF 1.1 has it.
    """
    if not path.exists():
        raise KnowledgeError(f"{path}: no such ontology file")
    # One scope a file: `_:1` of two files are two blank nodes. IRIs recur, so they are kept, too.
    scope: dict[str, Node] = {}
    graph = Graph()
    for triple in read_triples(path):
        graph.add(_as_rdflib(triple, scope))
    return graph


def plain(triples: Iterable[tuple[Node, Node, Node]]) -> Graph:
    """A copy whose strings are plain literals."""
    graph = Graph()
    for subject, predicate, value in triples:
        if isinstance(value, Literal) and value.datatype == XSD.string:
            value = Literal(str(value))
        graph.add((subject, predicate, value))
    return graph


def _as_rdflib(triple: Triple, scope: dict[str, Node]) -> tuple[Node, Node, Node]:
    return (
        _node(triple.subject, scope),
        _node(triple.predicate, scope),
        _node(triple.object, scope),
    )


def _node(term: object, scope: dict[str, Node]) -> Node:
    if isinstance(term, NamedNode | BlankNode):
        key = str(term)
        if key not in scope:
            scope[key] = URIRef(term.value) if isinstance(term, NamedNode) else BNode()
        return scope[key]
    assert isinstance(term, OxLiteral)
    if term.language:
        return Literal(term.value, lang=term.language)
    datatype = URIRef(term.datatype.value)
    return Literal(term.value) if datatype == XSD.string else Literal(term.value, datatype=datatype)
