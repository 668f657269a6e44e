"""Pitfalls of properties: domain, range, inverses, chains."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib.namespace import OWL, RDF, RDFS
from rdflib.term import Node

from afkb.quality.checked import Checked, short
from afkb.quality.pitfall import Found, in_order, own_of

_LOGICAL = (OWL.ObjectProperty, OWL.DatatypeProperty)


def no_domain_or_range(checked: Checked) -> Iterator[Found]:
    """P11: properties that don't say what they are about."""
    for term in own_of(checked, *_LOGICAL):
        for what in (RDFS.domain, RDFS.range):
            if (term, what, None) not in checked.graph:
                mend = f"name its {short(what)}; Thing, where it may be anything"
                yield Found(term, f"{short(what)} is missing", mend)


def several_domains_or_ranges(checked: Checked) -> Iterator[Found]:
    """P19: two domains mean that a subject is of both classes."""
    for term in own_of(checked, *_LOGICAL):
        for what in (RDFS.domain, RDFS.range):
            found = in_order(checked.graph.objects(term, what))
            if len(found) > 1:
                named = " and ".join(short(o) for o in found)
                mend = "name one class, or the union of them"
                yield Found(term, f"every {short(what)} is {named} at once", mend)


def _inverses(checked: Checked) -> Iterator[tuple[Node, Node]]:
    for one, other in sorted(checked.graph.subject_objects(OWL.inverseOf)):
        if one in checked.own or other in checked.own:
            yield one, other


def wrong_inverses(checked: Checked) -> Iterator[Found]:
    """P05: the domain of one is not the range of the other."""
    graph = checked.graph
    for one, other in _inverses(checked):
        for a, b in ((one, other), (other, one)):
            domain, reach = graph.value(a, RDFS.domain), graph.value(b, RDFS.range)
            if domain is not None and reach is not None and domain != reach:
                what = f"goes from {short(domain)}; its inverse {short(b)} to {short(reach)}"
                yield Found(a, what, "let the domain of one be the range of the other")


def own_inverses(checked: Checked) -> Iterator[Found]:
    """P25: such a property is symmetric."""
    for one, other in _inverses(checked):
        if one == other:
            yield Found(one, "is its own inverse", "declare it symmetric instead")


def symmetric_inverses(checked: Checked) -> Iterator[Found]:
    """P26: a symmetric property is its own inverse and needs no other."""
    for one, other in _inverses(checked):
        if one != other and (one, RDF.type, OWL.SymmetricProperty) in checked.graph:
            what = f"is symmetric and has the inverse {short(other)}"
            yield Found(one, what, "take one of both out")


def short_chains(checked: Checked) -> Iterator[Found]:
    """P33: a chain of one property is a subproperty."""
    for term, chain in checked.graph.subject_objects(OWL.propertyChainAxiom):
        if term in checked.own and len(list(checked.graph.items(chain))) < 2:
            yield Found(term, "a chain has one property", "state a subproperty instead")
