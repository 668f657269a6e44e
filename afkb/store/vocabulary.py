"""The namespaces of a scene, and the few terms that the store itself has to name."""

from __future__ import annotations

from urllib.parse import quote, unquote

from pyoxigraph import NamedNode

AFN = "https://w3id.org/afkb/afnet#"
FORMAT_VERSION = 1
SCENES = "https://w3id.org/afkb/scene/"
# For names that a plugin uses and no ontology in use has; the same in every map.
OTHER_NAMES = "https://w3id.org/afkb/name#"

PREFIXES: dict[str, str] = {
    "afn": AFN,
    "bot": "https://w3id.org/bot#",
    "dcterms": "http://purl.org/dc/terms/",
    "geo": "http://www.opengis.net/ont/geosparql#",
    "geof": "http://www.opengis.net/def/function/geosparql/",
    "owl": "http://www.w3.org/2002/07/owl#",
    "prov": "http://www.w3.org/ns/prov#",
    "qudt": "http://qudt.org/schema/qudt/",
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "skos": "http://www.w3.org/2004/02/skos/core#",
    "sosa": "http://www.w3.org/ns/sosa/",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}

MAP_NODES = ("RobotPlace", "ObservedEntity", "DualPrediction", "CoOccurrencePrediction")


def term(curie: str) -> NamedNode:
    """The IRI of a prefixed name.

    >>> term("afn:Mug").value
    'https://w3id.org/afkb/afnet#Mug'
    """
    prefix, _, local = curie.partition(":")
    return NamedNode(PREFIXES[prefix] + local)


def local_name(iri: str) -> str:
    """The part of an IRI after its last `#` or `/`: the name by which people know it.

    >>> local_name("https://w3id.org/afkb/afnet#Mug")
    'Mug'
    """
    return unquote(iri.rsplit("#" if "#" in iri else "/", 1)[-1])


def escaped(name: str) -> str:
    """A name as it may stand in an IRI: anything unusual is percent-encoded.

    >>> escaped("my detector/2")
    'my%20detector%2F2'

    So is a dot at the end, which not every Turtle parser bears.
    """
    encoded = quote(name, safe="")
    return f"{encoded[:-1]}%2E" if encoded.endswith(".") else encoded


def map_graph(name: str) -> str:
    """The graph of a map of that name; `/` in it parts fleets, sites or robots.

    >>> map_graph("north/flat 3")
    'urn:afkb:map:north/flat%203'
    """
    return "urn:afkb:map:" + "/".join(escaped(part) for part in name.split("/"))
