"""The namespaces and the few names that the knowledge base asks for."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

AFN = "https://w3id.org/afkb/afnet#"
ONTOLOGY_IRI = "https://w3id.org/afkb/afnet"
VERSION = "0.2.0"
PRIOR_VERSION = "0.1.0"
SKOS = "http://www.w3.org/2004/02/skos/core#"
DCTERMS = "http://purl.org/dc/terms/"
RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
RDFS = "http://www.w3.org/2000/01/rdf-schema#"
OWL = "http://www.w3.org/2002/07/owl#"
XSD = "http://www.w3.org/2001/XMLSchema#"
RDF_TYPE = RDF + "type"
RDFS_LABEL = RDFS + "label"

COUNTED = "taken from data"
"""The status of figures that were counted."""
STATUSES = ("stated", "published taxonomy", COUNTED, "recalled", "proposed")
RELATIONS = ("below", "on", "near")
SOMETHING_ELSE = "SomethingElse"
UNKNOWN_ROOM = "UnknownRoom"


KINDS = {
    "structural": "StructuralAffordance",
    "material": "MaterialAffordance",
    "grasp": "GraspAffordance",
}
"""The class of a feature, by its kind."""


SUBJECTS = ("body", "surface", "opening", "upright", "part", "gap")
"""What a measure is of, and what a feature is grounded on."""
BY_DETECTOR, BY_MEASURES, BY_PRIOR = "detector", "measures", "category prior"
BY_WEAK_MEASURES, BY_NOTHING = "weak measures", "nothing"
GROUNDED_BY = (BY_DETECTOR, BY_MEASURES, BY_WEAK_MEASURES, BY_PRIOR, BY_NOTHING)
"""How detectors come to a feature: one of its own, measures of things, or what things are."""


def fragment(iri: str) -> str:
    """The part of an IRI after `#` or the last `/`: the name by which this project calls it.

    >>> fragment("https://w3id.org/afkb/afnet#Mug")
    'Mug'
    """
    return iri.rsplit("#", 1)[-1].rsplit("/", 1)[-1]


def property_iri(name: str) -> str:
    """The IRI of a property of the ontology; an IRI stays as it is.

    >>> property_iri("strength")
    'https://w3id.org/afkb/afnet#strength'
    """
    return name if ":" in name else AFN + name


def slug(name: str) -> str:
    """A name that may stand in an IRI.

    >>> slug("my home (2)")
    'my-home-2'
    """
    return re.sub(r"[^A-Za-z0-9_]+", "-", name).strip("-") or "extension"


@dataclass(frozen=True, slots=True)
class Names:
    """Which IRI a name stands for: the ontology's own, or those of an extension first.

    `own`: namespace of the terms that are stated. `known`: name to IRI, for names that stand for
    a term of another namespace than the ontology's.

    >>> Names("https://example.org/home#", {"Fern": "https://example.org/home#Fern"}).iri("Mug")
    'https://w3id.org/afkb/afnet#Mug'
    """

    own: str = AFN
    known: Mapping[str, str] = field(default_factory=dict)

    def new(self, name: str) -> str:
        """The IRI of a term that is stated here."""
        return self.own + name

    def iri(self, name: str) -> str:
        """The IRI that a name stands for."""
        return self.known.get(name, AFN + name)


BUNDLED = Names()
"""The names of the ontology itself."""
