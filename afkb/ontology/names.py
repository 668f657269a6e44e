"""The namespaces and the few names that the knowledge base asks for."""

from __future__ import annotations

AFN = "https://w3id.org/afkb/afnet#"
ONTOLOGY_IRI = "https://w3id.org/afkb/afnet"
VERSION = "0.1.0"
SKOS = "http://www.w3.org/2004/02/skos/core#"
DCTERMS = "http://purl.org/dc/terms/"
RDF_TYPE = "http://www.w3.org/1999/02/22-rdf-syntax-ns#type"
RDFS_LABEL = "http://www.w3.org/2000/01/rdf-schema#label"

STATUSES = ("stated", "published taxonomy", "taken from data", "recalled", "proposed")
RELATIONS = ("below", "on", "near")
SOMETHING_ELSE = "SomethingElse"
UNKNOWN_ROOM = "UnknownRoom"


KINDS = {
    "structural": "StructuralAffordance",
    "material": "MaterialAffordance",
    "grasp": "GraspAffordance",
}
"""The class of a feature, by its kind."""


def fragment(iri: str) -> str:
    """The part of an IRI after `#` or the last `/`: the name by which this project calls it.

    >>> fragment("https://w3id.org/afkb/afnet#Mug")
    'Mug'
    """
    return iri.rsplit("#", 1)[-1].rsplit("/", 1)[-1]
