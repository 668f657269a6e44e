"""What the page shows of the ontology, sorted to where it is shown."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from afkb.knowledge import Afbit, AfNet, Category, CoOccurrence, Dual, Feature
from afkb.knowledge.facts import Facts, read_facts
from afkb.ontology.names import KINDS, SKOS, fragment
from afkb.reference.figures import StatedCount, StatedFigures, figures_of, read_counts
from afkb.reference.stated import (
    Header,
    Term,
    header_of,
    labels_of,
    links_of,
    terms_of,
    vocabulary_of,
)

T = TypeVar("T")
WORDS = {
    "Shape": "Shapes",
    "Material": "Materials",
    "Trait": "Traits",
    "ObjectPart": "Parts",
    "Pose": "Poses",
    "MovingHabit": "How often things are moved",
    "NetworkParameter": "Parameters of the network",
}
"""Classes whose individuals get a table each, with its heading."""


@dataclass(frozen=True, slots=True)
class Book:
    """The ontology in the order of the page; every mapping's keys are names of terms.

    `afbits`: of a category, by kind of feature. `afforded`: of a feature, the surest first.
    `narrower`: of a feature, category or group. `links`: by IRI.
    `words`: the small tables by heading.
    """

    base: AfNet
    facts: Facts
    header: Header
    labels: Mapping[str, str]
    links: Mapping[str, list[tuple[str, str]]]
    features: Mapping[str, list[Feature]]
    categories: list[Category]
    afbits: Mapping[str, Mapping[str, list[Afbit]]]
    afforded: Mapping[str, list[Afbit]]
    narrower: Mapping[str, list[str]]
    made_by: Mapping[str, int]
    duals_from: Mapping[str, list[Dual]]
    duals_to: Mapping[str, list[Dual]]
    pairs_of: Mapping[str, list[CoOccurrence]]
    evidence: Mapping[str, list[StatedCount]]
    in_rooms: StatedFigures
    together: StatedFigures
    supports: StatedFigures
    groups: list[Term]
    rules: list[Term]
    words: Mapping[str, list[Term]]
    vocabulary: list[Term]


def read_book(base: AfNet) -> Book:
    """The book of a knowledge base, its extensions included."""
    facts = read_facts(base.files)
    groups = terms_of(facts, "CategoryGroup", ("entityClass",))
    figures = figures_of(base, facts)
    rules = terms_of(facts, "AfbitRule", ("ofFeature", "ofPart", "strength"))
    return Book(
        base=base,
        facts=facts,
        header=header_of(facts, (file.name for file in base.files[1:])),
        labels=labels_of(facts),
        links=links_of(facts, base.files[0].parent / "alignments"),
        features={k: _by_label(f for f in base.features.values() if f.kind == k) for k in KINDS},
        categories=_by_label(base.categories.values()),
        afbits=_afbits_by_category(base),
        afforded=grouped(sorted(base.afbits, key=_surest), lambda a: [a.feature]),
        narrower=_narrower(facts),
        made_by={name: len(a) for name, a in grouped(base.afbits, lambda a: a.rules).items()},
        duals_from=grouped(base.duals, lambda dual: [dual.evidence]),
        duals_to=grouped(base.duals, lambda dual: [dual.predicted]),
        pairs_of=grouped(base.co_occurrences, _named_in),
        evidence=read_counts(facts),
        in_rooms=figures["ObjectInRoom"],
        together=figures["ObjectWithObject"],
        supports=figures["ObjectOnSupport"],
        groups=groups,
        rules=rules,
        words={heading: terms_of(facts, name, ("value",)) for name, heading in WORDS.items()},
        vocabulary=vocabulary_of(facts),
    )


def grouped(items: Iterable[T], keys: Callable[[T], Iterable[str]]) -> dict[str, list[T]]:
    """The items under each of their keys, in the order in which they come."""
    found: dict[str, list[T]] = defaultdict(list)
    for item in items:
        for key in keys(item):
            found[key].append(item)
    return dict(found)


_Labelled = TypeVar("_Labelled", Feature, Category)


def _by_label(items: Iterable[_Labelled]) -> list[_Labelled]:
    return sorted(items, key=lambda item: (item.label.casefold(), item.name))


def _surest(afbit: Afbit) -> tuple[float, str, str]:
    return (-afbit.strength, afbit.category, afbit.part or "")


def _afbits_by_category(base: AfNet) -> dict[str, dict[str, list[Afbit]]]:
    return {
        category: grouped(sorted(afbits, key=_surest), lambda a: [base.features[a.feature].kind])
        for category, afbits in grouped(base.afbits, lambda a: [a.category]).items()
    }


def _narrower(facts: Facts) -> dict[str, list[str]]:
    names = grouped(
        sorted(facts.values), lambda iri: map(fragment, facts.many(iri, SKOS + "broader"))
    )
    return {broader: sorted(map(fragment, iris)) for broader, iris in names.items()}


def _named_in(pair: CoOccurrence) -> list[str]:
    named = (
        pair.evidence_class,
        pair.predicted_class,
        pair.evidence_category,
        pair.predicted_category,
    )
    return sorted({name for name in named if name is not None})
