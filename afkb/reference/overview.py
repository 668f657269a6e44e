"""How much the ontology states, by kind and status: the page's first table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import Graph, Literal, URIRef

from afkb.knowledge.facts import Facts
from afkb.ontology.names import AFN, DCTERMS, RDF_TYPE

if TYPE_CHECKING:
    from afkb.quality.counts import KindCount

_TERMS = (RDF_TYPE, AFN + "ofFeature")
_VALUES = tuple(AFN + name for name in ("status", "independentSources", "reviewed"))
_KINDS = {
    "StructuralAffordance": "structural affordances",
    "MaterialAffordance": "material affordances",
    "GraspAffordance": "grasp affordances",
    "ObjectCategory": "objects",
    "CategoryGroup": "groups of objects",
    "RoomCategory": "rooms",
    "EvidenceClass": "evidence classes of rooms",
    "RoomEvidence": "counts of evidence in rooms",
    "Dual": "duals, each direction",
    "CoOccurrence": "co-occurrences",
    "ObjectInRoom": "figures: object in room",
    "ObjectWithObject": "figures: object with object",
    "ObjectOnSupport": "figures: object on object",
    "AfbitRule": "rules that make afbits",
    "ReportRate": "report rates",
    "Trapezoid": "ranges of grounding",
    "Shape": "shapes",
    "Material": "materials",
    "Trait": "traits",
    "ObjectPart": "parts",
    "Pose": "poses",
    "Scale": "scales",
    "NetworkParameter": "parameters of the network",
    "MovingHabit": "moving habits",
    "Movability": "movability",
    "Class": "defined classes of things",
}


def overview(facts: Facts) -> list[tuple[str, KindCount]]:
    """What `afkb ontology status` counts, with words for people, largest concerns first."""
    from afkb.quality.counts import count_statements

    counts = count_statements(_counted(facts))
    order = ["structural afbits", "material afbits", "grasp afbits", *_KINDS]
    place = {kind: number for number, kind in enumerate(order)}
    counts.sort(key=lambda row: (row.kind == "all", place.get(row.kind, len(order)), row.kind))
    return [(_KINDS.get(row.kind, _words(row.kind)), row) for row in counts]


def _words(kind: str) -> str:
    return kind if " " in kind else "".join(f" {c.lower()}" if c.isupper() else c for c in kind)


def _counted(facts: Facts) -> Graph:
    """The few statements that are counted, as the graph that the count is made of."""
    graph = Graph()
    for subject, said in facts.values.items():
        term = URIRef(subject)
        for prop in _TERMS:
            for value in said.get(prop, ()):
                graph.add((term, URIRef(prop), URIRef(value)))
        for prop in (*_VALUES, DCTERMS + "source"):
            for value in said.get(prop, ()):
                graph.add((term, URIRef(prop), Literal(value)))
    return graph
