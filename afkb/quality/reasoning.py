"""Whether the ontology is consistent and every class can have an instance, under HermiT.

How the whole set of individuals is checked in one run: each class gets a made-up instance, its
witness, and HermiT is asked whether everything together is consistent. That is sound: a model of
it is a model of the ontology in which no class is empty. Only where there is none are further
runs made, to tell an inconsistency from an empty class and to name what is at fault.

HermiT overlooks a value that is outside the range `xsd:double`; the shapes look at datatypes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rdflib import BNode, URIRef
from rdflib.namespace import OWL, RDF, RDFS
from rdflib.term import Node

from afkb.quality.checked import Checked, short
from afkb.quality.explanation import smallest
from afkb.quality.findings import Finding
from afkb.quality.pitfall import in_order
from afkb.quality.reasoner import Triple, is_consistent, logical, unsatisfiable_classes

_WITNESS = "urn:afkb:witness:"
_TERMS = (
    OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, OWL.AnnotationProperty, OWL.Ontology,
    OWL.Restriction, RDFS.Datatype,
)  # fmt: skip
"""What classes, properties and their like are declared as."""


def check_reasoning(checked: Checked) -> list[Finding]:
    """Contradictions and classes that can have no instance; `KnowledgeError` without Java."""
    triples = logical(checked.graph)
    witnesses = _witnesses(triples)
    if is_consistent([*triples, *witnesses]):
        return []
    triples.sort(key=_text)
    if is_consistent(triples):
        return [_empty(checked, c) for c in _unsatisfiable(triples, witnesses)]
    return _contradiction(checked, triples)


def _text(triple: Triple) -> tuple[str, ...]:
    return tuple(map(str, triple))


def _witnesses(triples: Sequence[Triple]) -> list[Triple]:
    classes = {s for s, p, o in triples if p == RDF.type and o == OWL.Class}
    named = sorted(c for c in classes if isinstance(c, URIRef) and c != OWL.Nothing)
    return [(URIRef(_WITNESS + str(n)), RDF.type, c) for n, c in enumerate(named)]


def _unsatisfiable(triples: Sequence[Triple], witnesses: Sequence[Triple]) -> list[Node]:
    """The classes that the class axioms empty; else those that the individuals empty."""
    terms, _ = _split(triples)
    found = unsatisfiable_classes(terms)
    if found:
        return list(found)
    clash = smallest(witnesses, lambda some: not is_consistent([*triples, *some]))
    return [c for _, _, c in clash]


def _empty(checked: Checked, term: Node) -> Finding:
    what = "no individual can be of this class"
    return checked.finding(
        term, what, "mend its axioms, those of broader classes, or a disjointness"
    )


def _contradiction(checked: Checked, triples: Sequence[Triple]) -> list[Finding]:
    """The fewest statements about individuals that the class axioms rule out together."""
    terms, facts = _split(triples)
    if not is_consistent(terms):
        first = min(checked.own, default=URIRef("ontology"))
        what = "the axioms on classes and properties contradict each other"
        return [checked.finding(first, what, "take out the axiom that was added last")]

    def is_bad(some: Sequence[Triple]) -> bool:
        return not is_consistent([*terms, *some])

    clash = smallest(_near(facts, is_bad), is_bad)
    said = " and ".join(" ".join(short(node) for node in fact) for fact in clash)
    return [
        checked.finding(subject, f"can't all be: {said}", "take one of them back")
        for subject in in_order({s for s, _, _ in clash})
    ]


def _near(facts: Sequence[Triple], is_bad: Callable[[Sequence[Triple]], bool]) -> list[Triple]:
    """Facts about few individuals, and what those name, that are bad by themselves.

    Each question is about half as much as the one before, so all cost little more than the first.
    """
    of: dict[Node, list[Triple]] = {}
    for fact in facts:
        of.setdefault(fact[0], []).append(fact)
    some, found = list(of), list(facts)
    while len(some) > 1:
        middle = len(some) // 2
        for half in (some[:middle], some[middle:]):
            named = {value for subject in half for _, _, value in of[subject] if value in of}
            part = [fact for subject in {*half, *named} for fact in of[subject]]
            if is_bad(part):
                some, found = half, part
                break
        else:
            break
    return sorted(found, key=_text)


def _split(triples: Sequence[Triple]) -> tuple[list[Triple], list[Triple]]:
    """Axioms on classes and properties, and what is stated of individuals."""
    declared = {s for s, p, o in triples if p == RDF.type and o in _TERMS}
    facts = [t for t in triples if t[0] not in declared and _is_fact(t)]
    of_individuals = set(facts)
    return [t for t in triples if t not in of_individuals], facts


def _is_fact(triple: Triple) -> bool:
    subject, predicate, value = triple
    if isinstance(subject, BNode) or value == OWL.NamedIndividual:
        return False
    of_words = str(predicate).startswith((str(RDFS), str(OWL)))
    return not of_words or predicate in (OWL.sameAs, OWL.differentFrom)
