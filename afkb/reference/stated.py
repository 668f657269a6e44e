"""What is stated of a term beside what the knowledge base types: examples, notes, links, words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from afkb.knowledge.facts import Facts, read_facts
from afkb.ontology.names import (
    AFN,
    DCTERMS,
    ONTOLOGY_IRI,
    OWL,
    RDF_TYPE,
    RDFS,
    RDFS_LABEL,
    SKOS,
    fragment,
)

_LINKS = {
    *(SKOS + name for name in ("exactMatch", "closeMatch", "broadMatch", "narrowMatch")),
    OWL + "sameAs",
    RDFS + "seeAlso",
}
_PROPERTIES = ("ObjectProperty", "DatatypeProperty")


@dataclass(frozen=True, slots=True)
class Term:
    """A term of which the page needs only what every term has, and what it is said of."""

    name: str
    iri: str
    label: str
    definition: str
    examples: tuple[str, ...]
    status: str
    source: str
    place: str
    said: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Header:
    """What the ontology says of itself, and the extensions that are read with it."""

    title: str
    description: str
    version: str
    version_iri: str
    licence: str
    extensions: tuple[str, ...]


def header_of(facts: Facts, extensions: Iterable[str]) -> Header:
    """The header of the ontology; empty text for what it does not say."""

    def said(prop: str) -> str:
        return facts.text(ONTOLOGY_IRI, prop, default="")

    return Header(
        title=said(DCTERMS + "title") or "Affordance ontology",
        description=said(DCTERMS + "description"),
        version=said(OWL + "versionInfo"),
        version_iri=said(OWL + "versionIRI"),
        licence=said(DCTERMS + "license"),
        extensions=tuple(extensions),
    )


def terms_of(facts: Facts, class_name: str, said: Iterable[str] = ()) -> list[Term]:
    """The individuals of one of the ontology's classes, by label; `said`: more of their values."""
    return by_label(_term(facts, iri, said) for iri in facts.of_type(class_name))


def vocabulary_of(facts: Facts) -> list[Term]:
    """The classes and properties of the ontology's own words, without the classes of entities."""
    entities = {v for p in facts.values.values() for v in p.get(AFN + "entityClass", ())}
    wanted = {OWL + name for name in ("Class", *_PROPERTIES)}
    return by_label(
        _term(facts, iri, (RDFS + "domain", RDFS + "range", RDFS + "subClassOf"))
        for iri, said in facts.values.items()
        if wanted & set(said.get(RDF_TYPE, ())) and iri.startswith(AFN) and iri not in entities
    )


def by_label(terms: Iterable[Term]) -> list[Term]:
    """Terms in the order in which a reader looks for them."""
    return sorted(terms, key=lambda term: (term.label.casefold(), term.name))


def _term(facts: Facts, iri: str, said: Iterable[str]) -> Term:
    return Term(
        name=fragment(iri),
        iri=iri,
        label=facts.text(iri, RDFS_LABEL, default=fragment(iri)),
        definition=facts.text(iri, SKOS + "definition", default=""),
        examples=tuple(facts.many(iri, SKOS + "example")),
        status=facts.text(iri, "status", default=""),
        source=facts.text(iri, DCTERMS + "source", default=""),
        place=facts.text(iri, "fromRow", default=facts.file_of[iri].name),
        said=tuple(
            (fragment(p), _short(v)) for p in said for v in facts.many(iri, p) if v[:2] != "_:"
        ),
    )


def _short(value: str) -> str:
    return fragment(value) if value.startswith("http") else value


def labels_of(facts: Facts) -> dict[str, str]:
    """Name to label, of every term that has one; the file that is read first has precedence."""
    labels: dict[str, str] = {}
    for iri, said in facts.values.items():
        for label in said.get(RDFS_LABEL, ())[:1]:
            labels.setdefault(fragment(iri), label)
    return labels


def links_of(facts: Facts, alignments: Path) -> dict[str, list[tuple[str, str]]]:
    """IRI to what means the same elsewhere: the property's name and the other's IRI.

    `alignments`: a folder of Turtle files beside the ontology; it need not be there.
    """
    stated = [facts, *(read_facts([file]) for file in sorted(alignments.glob("*.ttl")))]
    links: dict[str, list[tuple[str, str]]] = {}
    for some in stated:
        for iri, said in some.values.items():
            for prop in _LINKS & said.keys():
                links.setdefault(iri, []).extend((fragment(prop), v) for v in sorted(said[prop]))
    return {iri: sorted(found) for iri, found in links.items()}
