"""Pitfalls of the ontology header."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from rdflib import BNode, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS

from afkb.ontology.rdf_files import RDF_FORMATS
from afkb.quality.checked import Checked
from afkb.quality.pitfall import Found, own_of

_METADATA = {
    OWL.versionIRI: "owl:versionIRI",
    DCTERMS.title: "dcterms:title",
    DCTERMS.description: "dcterms:description",
    DCTERMS.creator: "dcterms:creator",
    DCTERMS.created: "dcterms:created",
    DCTERMS.modified: "dcterms:modified",
}


def no_header(checked: Checked) -> Iterator[Found]:
    """P38: files of RDF that declare no ontology."""
    named = set(own_of(checked, OWL.Ontology))
    nameless = any(isinstance(o, BNode) for o in checked.graph.subjects(RDF.type, OWL.Ontology))
    for file in sorted({f for f in checked.own.values() if f is not None and _is_rdf(f)}):
        if not nameless and not any(checked.own[o] == file for o in named):
            yield Found(URIRef(str(file)), "no owl:Ontology is declared", "declare it with its IRI")
    if checked.bundled and not named and not nameless and None in checked.own.values():
        yield Found(URIRef("#header"), "no owl:Ontology is declared", "declare it with its IRI")


def _is_rdf(file: Path) -> bool:
    return file.suffix in RDF_FORMATS


def nameless(checked: Checked) -> Iterator[Found]:
    """P39: an ontology that nobody can refer to."""
    for ontology in checked.graph.subjects(RDF.type, OWL.Ontology):
        if isinstance(ontology, BNode):
            yield Found(ontology, "the ontology has no IRI", "give it one by rdf:about")


def no_licence(checked: Checked) -> Iterator[Found]:
    """P41: nobody can tell whether it may be used."""
    licences = (DCTERMS.license, DCTERMS.rights, URIRef("http://purl.org/dc/elements/1.1/rights"))
    for ontology in own_of(checked, OWL.Ontology):
        if not any((ontology, licence, None) in checked.graph for licence in licences):
            yield Found(ontology, "no licence", "state dcterms:license")


def no_metadata(checked: Checked) -> Iterator[Found]:
    """What people look for in the header of a published ontology."""
    for ontology in own_of(checked, OWL.Ontology) if checked.bundled else ():
        for predicate, name in _METADATA.items():
            if (ontology, predicate, None) not in checked.graph:
                yield Found(ontology, f"{name} is missing in the header", "state it")
        if (ontology, RDFS.label, None) not in checked.graph:
            yield Found(ontology, "rdfs:label is missing in the header", "state it")
