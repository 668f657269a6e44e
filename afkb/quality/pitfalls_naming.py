"""Pitfalls of names, labels and definitions."""

from __future__ import annotations

import re
from collections.abc import Iterator

from rdflib import URIRef
from rdflib.namespace import OWL, RDFS, SKOS

from afkb.ontology.names import AFN, fragment
from afkb.quality.checked import Checked, short
from afkb.quality.pitfall import PROPERTIES, Found, classes_of, own_of, twice

_UPPER = re.compile(r"[A-Z][A-Za-z0-9]*")
_LOWER = re.compile(r"[a-z][A-Za-z0-9]*")
_MEASURE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_ONE_SHELF = {"CategoryGroup": "ObjectCategory", "StructuralAffordance": "Affordance",
              "MaterialAffordance": "Affordance", "GraspAffordance": "Affordance"}  # fmt: skip
"""Classes whose individuals people look up together, so that labels must tell them apart."""


def other_styles(checked: Checked) -> Iterator[Found]:
    """P22: terms are `UpperCamelCase`, properties `lowerCamelCase`, joined by dots."""
    properties = set(own_of(checked, *PROPERTIES))
    ontologies = set(own_of(checked, OWL.Ontology))
    for term in sorted(set(checked.own) - ontologies):
        style = _LOWER if term in properties else _UPPER
        word = "lowerCamelCase" if term in properties else "UpperCamelCase"
        first, *rest = fragment(str(term)).split(".")
        if not style.fullmatch(first) or not all(
            _UPPER.fullmatch(part) or _MEASURE.fullmatch(part) for part in rest
        ):
            yield Found(term, f"the name is not {word}", "rename it everywhere")


def file_suffixes(checked: Checked) -> Iterator[Found]:
    """P36: an IRI should outlive the form of its file."""
    for term in sorted(checked.own):
        if re.search(r"\.(owl|rdf|ttl|n3|xml|rdfxml|yaml|csv)(?=[#/]|$)", str(term)):
            yield Found(term, f"the IRI {term} names a file", "leave the suffix out of the IRI")


def is_relations(checked: Checked) -> Iterator[Found]:
    """P03: `is` is `rdf:type` or `rdfs:subClassOf`."""
    for term in own_of(checked, *PROPERTIES):
        if fragment(str(term)).lower() in ("is", "isa", "is_a"):
            yield Found(term, "says what a type or subclass says", "use rdf:type or a subclass")


def missing_annotations(checked: Checked) -> Iterator[Found]:
    """P08: classes and properties; the shapes look at individuals."""
    needed = {RDFS.label: "label", SKOS.definition: "definition", SKOS.example: "example"}
    for term in own_of(checked, OWL.Class, *PROPERTIES):
        for predicate, name in needed.items():
            if (term, predicate, None) not in checked.graph:
                yield Found(term, f"{name} is missing", f"state its {name}")


def mixed_up_annotations(checked: Checked) -> Iterator[Found]:
    """P20: a definition that only repeats the label, or a label that is a definition."""
    for term in sorted(checked.own):
        label, definition = (
            _words(str(checked.graph.value(term, predicate) or ""))
            for predicate in (RDFS.label, SKOS.definition)
        )
        if definition and definition == label[: len(definition)]:
            yield Found(term, "the definition says no more than the label", "say what tells it")


def _words(text: str) -> list[str]:
    return [word for word in re.findall(r"\w+", text.casefold()) if word not in ("a", "an", "the")]


def circular(checked: Checked) -> Iterator[Found]:
    """P24: a definition that begins with what it defines."""
    for term in sorted(checked.own):
        label = checked.graph.value(term, RDFS.label)
        definition = checked.graph.value(term, SKOS.definition)
        if label is None or definition is None:
            continue
        start = rf"(an? |the )?{re.escape(str(label))}( is\b| that\b|\.|,)"
        if re.match(start, str(definition), re.IGNORECASE):
            yield Found(term, "the definition begins with the term", "say it in other words")


def equal_labels(checked: Checked) -> Iterator[Found]:
    """P32: classes, and individuals that people look up together, of one label."""
    for term, first in twice(_labelled(checked)):
        if term not in checked.own:
            continue
        label = checked.graph.value(term, RDFS.label)
        yield Found(term, f"{short(first)} is called {str(label)!r}, too", "let labels differ")


def _labelled(checked: Checked) -> Iterator[tuple[object, URIRef]]:
    """Shelf and label of every term, others' first, so that the checked one is told.

    Properties are left out, and statements, whose names are joined by dots.
    """
    properties = {p for kind in PROPERTIES for p in checked.graph.subjects(None, kind)}
    everything = {URIRef(str(t)) for t in checked.graph.subjects(RDFS.label, None)}
    terms = {t for t in everything - properties if "." not in fragment(t)}
    for term in sorted(terms, key=lambda t: (t in checked.own, t)):
        for kind in classes_of(checked.graph, term):
            shelf = _ONE_SHELF.get(str(kind).removeprefix(AFN), short(kind))
            for label in checked.graph.objects(term, RDFS.label):
                yield (shelf, str(label).casefold(), getattr(label, "language", None)), term


def equal_property_labels(checked: Checked) -> Iterator[Found]:
    """P12: two properties of one label are one property, or their labels say too little."""
    graph = checked.graph
    terms = {p for kind in PROPERTIES for p in graph.subjects(None, kind)}
    named = sorted(terms, key=lambda t: (t in checked.own, t))
    pairs = (
        (str(o).casefold(), URIRef(str(t))) for t in named for o in graph.objects(t, RDFS.label)
    )
    for term, first in twice(pairs):
        if term in checked.own:
            yield Found(term, f"{short(first)} has the same label", "make them one, or tell apart")
