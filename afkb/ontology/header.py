"""The ontology's header, and the terms of others that it uses without importing them."""

from __future__ import annotations

from rdflib import Graph, Literal, URIRef
from rdflib.namespace import DCTERMS, OWL, PROV, RDF, RDFS, SKOS, XSD

from afkb.ontology.names import AFN, ONTOLOGY_IRI, VERSION

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
}
_DESCRIPTION = (
    "Affordance features, object and room categories, and the relationships by which seen things "
    "predict unseen ones, with the vocabulary of topological affordance maps. A reconstruction "
    "after the published descriptions of AfNet and AfRob: every statement carries its status and "
    "source, and nothing here is AfNet's own published list."
)
_ANNOTATIONS = (
    SKOS.definition, SKOS.example, SKOS.note, DCTERMS.source, DCTERMS.title, DCTERMS.description,
    DCTERMS.license, DCTERMS.created, DCTERMS.modified, DCTERMS.creator,
    DCTERMS.bibliographicCitation,
    URIRef(VANN + "preferredNamespacePrefix"), URIRef(VANN + "preferredNamespaceUri"),
)  # fmt: skip
_OBJECTS = (SKOS.broader, PROV.wasGeneratedBy, PROV.wasDerivedFrom, URIRef(GEO + "hasGeometry"))
_DATA = (URIRef(GEO + "asWKT"),)


def add_header(graph: Graph) -> None:
    """Name, version, licence, dates and authorship of the ontology."""
    ontology = URIRef(ONTOLOGY_IRI)
    graph.add((ontology, RDF.type, OWL.Ontology))
    graph.add((ontology, OWL.versionIRI, URIRef(f"{ONTOLOGY_IRI}/{VERSION}")))
    graph.add((ontology, OWL.versionInfo, Literal(VERSION)))
    texts = {
        DCTERMS.title: "AfNet/AfRob affordance ontology for household robots, a reconstruction",
        DCTERMS.description: _DESCRIPTION,
        DCTERMS.creator: "The afkb authors",
        DCTERMS.bibliographicCitation: (
            "After: Varadarajan and Vincze, Topological Mapping for Robot Navigation using "
            "Affordance Features."
        ),
        RDFS.label: "AfNet/AfRob reconstruction",
    }
    for predicate, text in texts.items():
        graph.add((ontology, predicate, Literal(text, lang="en")))
    licence = URIRef("https://creativecommons.org/licenses/by/4.0/")
    graph.add((ontology, DCTERMS.license, licence))
    graph.add((ontology, DCTERMS.created, Literal("2026-11-22", datatype=XSD.date)))
    graph.add((ontology, DCTERMS.modified, Literal("2026-11-22", datatype=XSD.date)))
    graph.add((ontology, URIRef(VANN + "preferredNamespacePrefix"), Literal("afn")))
    graph.add((ontology, URIRef(VANN + "preferredNamespaceUri"), Literal(AFN)))


def add_external_terms(graph: Graph) -> None:
    """Declare what is used of SKOS, Dublin Core, PROV and GeoSPARQL, so that OWL 2 DL holds."""
    for term in _ANNOTATIONS:
        graph.add((term, RDF.type, OWL.AnnotationProperty))
    for term in _OBJECTS:
        graph.add((term, RDF.type, OWL.ObjectProperty))
    for term in _DATA:
        graph.add((term, RDF.type, OWL.DatatypeProperty))
