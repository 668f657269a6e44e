"""The ontology's header, and the terms of others that it uses without importing them."""

from __future__ import annotations

from rdflib import Graph, Literal, URIRef
from rdflib.namespace import DCTERMS, OWL, PROV, RDF, RDFS, SKOS, XSD
from rdflib.term import Node

from afkb.ontology.names import AFN, ONTOLOGY_IRI, PRIOR_VERSION, VERSION

GEO = "http://www.opengis.net/ont/geosparql#"
VANN = "http://purl.org/vocab/vann/"
PREFIXES = {
    "afn": AFN,
    "dcterms": str(DCTERMS),
    "geo": GEO,
    "owl": str(OWL),
    "prov": str(PROV),
    "rdf": str(RDF),
    "rdfs": str(RDFS),
    "skos": str(SKOS),
    "vann": VANN,
    "xsd": str(XSD),
}
CREATED, MODIFIED = "2026-11-22", "2026-11-22"
LICENCE = "https://creativecommons.org/licenses/by/4.0/"
RECONSTRUCTION = (
    "A reconstruction after the published descriptions of AfNet and AfRob: every statement "
    "carries its status and source, and nothing here is AfNet's own published list."
)
_TITLE = "AfNet/AfRob affordance ontology for household robots, a reconstruction"
_DESCRIPTION = (
    "Affordance features, object and room categories, and the relationships by which seen things "
    "predict unseen ones, with the vocabulary of topological affordance maps. " + RECONSTRUCTION
)
_CITATION = (
    "After: Varadarajan and Vincze, Topological Mapping for Robot Navigation using Affordance "
    "Features."
)
_ANNOTATIONS = (
    SKOS.definition, SKOS.example, SKOS.note, DCTERMS.source, DCTERMS.title, DCTERMS.description,
    DCTERMS.license, DCTERMS.created, DCTERMS.modified, DCTERMS.creator,
    DCTERMS.bibliographicCitation,
    URIRef(VANN + "preferredNamespacePrefix"), URIRef(VANN + "preferredNamespaceUri"),
)  # fmt: skip
_OBJECTS = (SKOS.broader, PROV.wasGeneratedBy, PROV.wasDerivedFrom, URIRef(GEO + "hasGeometry"))
_DATA = (URIRef(GEO + "asWKT"),)


def add_header(
    graph: Graph, iri: str = ONTOLOGY_IRI, title: str = _TITLE, description: str = _DESCRIPTION
) -> None:
    """Name, version, licence, dates and authorship of an ontology file.

    The whole was there before its modules and alignments: it alone has a prior version.
    """
    for predicate, value in _header(iri, title, description):
        graph.add((URIRef(iri), predicate, value))
    if iri == ONTOLOGY_IRI:
        graph.add((URIRef(iri), OWL.priorVersion, URIRef(f"{iri}/{PRIOR_VERSION}")))


def _header(iri: str, title: str, description: str) -> list[tuple[URIRef, Node]]:
    namespace = URIRef(VANN + "preferredNamespaceUri"), Literal(AFN)
    return [
        (RDF.type, OWL.Ontology),
        (OWL.versionIRI, URIRef(f"{iri}/{VERSION}")),
        (OWL.versionInfo, Literal(VERSION)),
        (RDFS.label, Literal(title, lang="en")),
        (RDFS.comment, Literal(RECONSTRUCTION, lang="en")),
        (DCTERMS.title, Literal(title, lang="en")),
        (DCTERMS.description, Literal(description, lang="en")),
        (DCTERMS.creator, Literal("The afkb authors", lang="en")),
        (DCTERMS.bibliographicCitation, Literal(_CITATION, lang="en")),
        (DCTERMS.license, URIRef(LICENCE)),
        (DCTERMS.created, Literal(CREATED, datatype=XSD.date)),
        (DCTERMS.modified, Literal(MODIFIED, datatype=XSD.date)),
        (URIRef(VANN + "preferredNamespacePrefix"), Literal("afn")),
        namespace,
    ]


def add_external_terms(graph: Graph) -> None:
    """Declare what is used of SKOS, Dublin Core, PROV and GeoSPARQL, so that OWL 2 DL holds."""
    for term in _ANNOTATIONS:
        graph.add((term, RDF.type, OWL.AnnotationProperty))
    for term in _OBJECTS:
        graph.add((term, RDF.type, OWL.ObjectProperty))
    for term in _DATA:
        graph.add((term, RDF.type, OWL.DatatypeProperty))
