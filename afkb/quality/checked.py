"""What is checked: the terms of some files, among all that is known beside them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from pathlib import Path

from rdflib import Graph, URIRef
from rdflib.term import Node

from afkb.ontology.names import AFN, fragment
from afkb.ontology.statements import FROM_ROW
from afkb.quality.findings import Finding
from afkb.quality.reading import plain, read_graphs

_OTHERS = (
    "http://www.w3.org/", "http://purl.org/", "http://www.opengis.net/", "http://xmlns.com/",
    "https://schema.org/", "http://schema.org/",
)  # fmt: skip
"""Namespaces whose terms are others' to define."""


@dataclass(frozen=True, slots=True)
class Checked:
    """The statements of all files, and which terms are looked at.

    `own`: terms that the checked files make statements about, with the file of each; others'
    terms (SKOS, Dublin Core, …) are left out. `bundled`: whether they are this project's own
    ontology, which is held to more than a user's extension.
    """

    graph: Graph
    own: Mapping[URIRef, Path | None]
    bundled: bool
    rows: Mapping[URIRef, str] = field(default_factory=dict)

    @classmethod
    def of_graph(cls, graph: Graph) -> Checked:
        """The ontology as `build_ontology` gives it, before any file is written."""
        everything = plain(graph)
        return cls(everything, dict.fromkeys(terms_of(everything)), True, _rows(everything))

    @classmethod
    def of_files(cls, files: Sequence[Path], context: Sequence[Path] = ()) -> Checked:
        """The files, against others as context; without context they are the ontology itself.

        `KnowledgeError`, with file and line, where one can't be read.
        """
        graphs = read_graphs([*context, *files])
        own: dict[URIRef, Path | None] = {}
        rows: dict[URIRef, str] = {}
        for path in files:
            own |= dict.fromkeys(terms_of(graphs[path]), path)
            rows |= _rows(graphs[path])
        everything = reduce(_joined, graphs.values(), Graph())
        return cls(everything, own, not context, rows)

    def place(self, term: Node) -> str:
        """Where a term is stated: the row of a table, else the line of a file."""
        row = self.rows.get(URIRef(str(term)))
        file = self.own.get(URIRef(str(term)))
        if row or file is None:
            return row or str(self.graph.value(term, FROM_ROW) or "?")
        line = line_of(file, str(term))
        return f"{file}, line {line}" if line else str(file)

    def finding(self, term: Node, what: str, mend: str, advice: bool = False) -> Finding:
        """A finding about a term."""
        return Finding(self.place(term), short(term), what, mend, advice)


def _joined(one: Graph, other: Graph) -> Graph:
    """Both graphs; the smaller is added to the larger, which is quicker than a third."""
    large, small = (one, other) if len(one) > len(other) else (other, one)
    for triple in small:
        large.add(triple)
    return large


def terms_of(graph: Graph) -> set[URIRef]:
    """The named terms that a graph makes statements about, without those of others."""
    named = (s for s in set(graph.subjects()) if isinstance(s, URIRef))
    return {s for s in named if not str(s).startswith(_OTHERS)}


def short(term: Node | str) -> str:
    """A term as people call it: by its name, without the namespace where it is ours."""
    text = str(term)
    return text.removeprefix(AFN) if text.startswith(AFN) else fragment(text) or text


def line_of(file: Path, iri: str) -> int | None:
    """The line of an RDF file that names a subject; None where it can't be told."""
    if not file.is_file():
        return None
    name = re.escape(fragment(iri))
    about = re.compile(rf'rdf:(?:about|ID)="(?:[^"]*[#/;])?{name}"')
    turtle = re.compile(rf"\s*(?:[\w-]*:|<[^>]*[#/])?{name}>?(?:\s|$)")
    lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    return _first(lines, about.search) or _first(lines, turtle.match)


def _first(lines: Iterable[str], matches: object) -> int | None:
    assert callable(matches)
    return next((number for number, line in enumerate(lines, 1) if matches(line)), None)


def _rows(graph: Graph) -> dict[URIRef, str]:
    return {URIRef(str(s)): str(place) for s, place in graph.subject_objects(FROM_ROW)}
