"""Counts what the ontology states, by kind and status, and how far it is vouched for."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from rdflib import Graph, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF

from afkb.ontology.names import AFN, STATUSES
from afkb.quality.checked import short
from afkb.quality.pitfall import classes_of

_STATUS, _SOURCES, _REVIEWED, _FEATURE = (
    URIRef(AFN + name) for name in ("status", "independentSources", "reviewed", "ofFeature")
)
_AFBITS = {
    "StructuralAffordance": "structural afbits",
    "MaterialAffordance": "material afbits",
    "GraspAffordance": "grasp afbits",
}


@dataclass(frozen=True, slots=True)
class KindCount:
    """How many individuals of a kind there are, of which status, and how well vouched for.

    `with_provenance`: those with a status and a source; `with_two_sources`: those for which two
    public tables, or one and the paper, speak; `reviewed`: those that a person judged.
    """

    kind: str
    number: int
    by_status: dict[str, int]
    with_provenance: int
    with_two_sources: int
    reviewed: int


def count_statements(graph: Graph) -> list[KindCount]:
    """One row a kind, afbits by kind of feature, and `all` at the end."""
    kinds: dict[str, list[URIRef]] = {}
    for term in {*graph.subjects(RDF.type, OWL.NamedIndividual), *graph.subjects(_STATUS)}:
        if isinstance(term, URIRef):
            kinds.setdefault(_kind(graph, term), []).append(term)
    rows = [_count(graph, kind, terms) for kind, terms in sorted(kinds.items())]
    stated = [term for terms in kinds.values() for term in terms]
    return [*rows, _count(graph, "all", stated)]


def _kind(graph: Graph, term: URIRef) -> str:
    names = [short(c) for c in classes_of(graph, term)]
    if "Afbit" in names:
        feature = graph.value(term, _FEATURE)
        of = [short(c) for c in classes_of(graph, feature)] if feature is not None else []
        return next((_AFBITS[name] for name in of if name in _AFBITS), "other afbits")
    return names[0] if names else "of no class"


def _count(graph: Graph, kind: str, terms: list[URIRef]) -> KindCount:
    statuses = Counter(str(graph.value(t, _STATUS) or "none") for t in terms)
    return KindCount(
        kind=kind,
        number=len(terms),
        by_status={s: statuses[s] for s in (*STATUSES, "none") if statuses[s]},
        with_provenance=sum(_has_provenance(graph, t) for t in terms),
        with_two_sources=sum(int(str(graph.value(t, _SOURCES) or 0)) >= 2 for t in terms),
        reviewed=sum(str(graph.value(t, _REVIEWED)) == "true" for t in terms),
    )


def _has_provenance(graph: Graph, term: URIRef) -> bool:
    return (term, _STATUS, None) in graph and (term, DCTERMS.source, None) in graph
