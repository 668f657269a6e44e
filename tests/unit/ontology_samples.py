"""Copies of the ontology with statements changed, and small extensions, as users would write."""

from __future__ import annotations

from pathlib import Path

from rdflib import Graph, Literal, URIRef
from rdflib.namespace import XSD

from afkb.knowledge import AFN, KnowledgeBase, bundled_ontology

_HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"
  xmlns:rdfs="http://www.w3.org/2000/01/rdf-schema#" xmlns:owl="http://www.w3.org/2002/07/owl#"
  xmlns:skos="http://www.w3.org/2004/02/skos/core#" xmlns:afn="https://w3id.org/afkb/afnet#">
<owl:Ontology rdf:about="https://example.org/home"/>
"""


def afn(name: str) -> URIRef:
    return URIRef(AFN + name)


class Copy:
    """A copy of the bundled ontology to change statement by statement."""

    def __init__(self) -> None:
        self.graph = Graph().parse(bundled_ontology(), format="xml")

    def set(self, subject: str, prop: str, value: float) -> Copy:
        assert (afn(subject), afn(prop), None) in self.graph
        self.graph.set((afn(subject), afn(prop), Literal(value, datatype=XSD.double)))
        return self

    def delete(self, subject: str) -> Copy:
        assert (afn(subject), None, None) in self.graph
        self.graph.remove((afn(subject), None, None))
        return self

    def load(self, folder: Path) -> KnowledgeBase:
        path = folder / "changed.owl"
        self.graph.serialize(path, format="xml")
        return KnowledgeBase(path)


def extension(folder: Path, body: str, name: str = "home.owl") -> Path:
    """An extension file with that body of RDF/XML, in the namespace https://example.org/home#."""
    path = folder / name
    path.write_text(_HEAD + body + "</rdf:RDF>\n", encoding="utf-8")
    return path
