"""Reads features, scales, afbits and categories: what there is, and what it affords."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TypedDict

from afkb.knowledge.facts import Facts
from afkb.knowledge.item_reading import (
    common,
    name_or_none,
    positive,
    range_of,
    range_or_none,
    read_all,
)
from afkb.knowledge.model import Afbit, Category, Feature, Measure, Scale, Trapezoid
from afkb.ontology.categories import movability_of
from afkb.ontology.names import (
    BY_DETECTOR,
    BY_MEASURES,
    GROUNDED_BY,
    KINDS,
    SKOS,
    SUBJECTS,
    fragment,
)

USUAL_STRENGTH = 0.8
"""Probability of a feature whose measures all fit, where its grounding states none."""


def read_features(facts: Facts) -> Mapping[str, Feature]:
    """The affordance features of all three kinds, by name."""
    ranges = _ranges(facts)
    features: dict[str, Feature] = {}
    for kind, class_name in KINDS.items():
        for iri in facts.of_type(class_name):
            features[fragment(iri)] = Feature(
                **common(facts, iri),
                kind=kind,
                definition=facts.text(iri, SKOS + "definition", default=""),
                grounding=facts.text(iri, "grounding", default=""),
                broader=name_or_none(facts.one(iri, SKOS + "broader")),
                parameters=MappingProxyType(ranges.get(iri, {})),
                **_grounding(facts, iri),
            )
    return MappingProxyType(dict(sorted(features.items())))


def _ranges(facts: Facts) -> dict[str, dict[str, Trapezoid]]:
    """The fuzzy ranges of each feature, by measure."""
    ranges: dict[str, dict[str, Trapezoid]] = {}
    for iri in facts.of_type("Trapezoid"):
        of_feature = ranges.setdefault(facts.text(iri, "ofFeature"), {})
        of_feature[facts.text(iri, "parameterName")] = _trapezoid(facts, iri)
    return ranges


class _Grounding(TypedDict):
    """What a feature states of how detectors come to it."""

    grounded_by: tuple[str, ...]
    grounded_on: tuple[str, ...]
    grounding_strength: float
    grounding_reason: str


def _grounding(facts: Facts, iri: str) -> _Grounding:
    """What is grounded on something, and says no more, is grounded by its measures."""
    grounded_on = tuple(w for w in SUBJECTS if w in facts.many(iri, "groundedOn"))
    grounded_by = tuple(w for w in GROUNDED_BY if w in facts.many(iri, "groundedBy"))
    usual = USUAL_STRENGTH if grounded_on and BY_DETECTOR not in grounded_by else 0.0
    return _Grounding(
        grounded_by=grounded_by or ((BY_MEASURES,) if grounded_on else ()),
        grounded_on=grounded_on,
        grounding_strength=facts.number(iri, "groundingStrength", default=usual),
        grounding_reason=facts.text(iri, "groundingReason", default=""),
    )


def read_measure(facts: Facts, iri: str) -> Measure:
    """One measure."""
    return Measure(
        **common(facts, iri),
        measure_name=facts.text(iri, "measureName"),
        measured_in=facts.text(iri, "measuredIn", default=""),
        measure_of=tuple(w for w in SUBJECTS if w in facts.many(iri, "measureOf")),
        primitive=facts.text(iri, "primitive", default=""),
        definition=facts.text(iri, SKOS + "definition", default=""),
    )


def _trapezoid(facts: Facts, iri: str) -> Trapezoid:
    z1, n1, n2, z2 = (facts.number(iri, p) for p in ("z1", "n1", "n2", "z2"))
    if not z1 <= n1 <= n2 <= z2:
        raise facts.error(iri, f"z1, n1, n2, z2 = {z1}, {n1}, {n2}, {z2} do not rise")
    return Trapezoid(z1, n1, n2, z2)


def read_scale(facts: Facts, iri: str) -> Scale:
    """One scale."""
    return Scale(**common(facts, iri), extent_m=range_of(facts, iri, "extent"))


def read_afbits(facts: Facts) -> tuple[Afbit, ...]:
    """The afbits, by category, part and feature; `KnowledgeError` where two say the same."""
    found: dict[tuple[str, str, str], Afbit] = {}
    known = set(facts.of_type("ObjectCategory"))
    for iri in facts.of_type("Afbit"):
        category = facts.text(iri, "ofCategory")
        if category not in known:
            raise facts.error(category, "has afbits but is no object category")
        afbit = _afbit(facts, iri, fragment(category))
        key = (afbit.category, afbit.part or "", afbit.feature)
        if key in found:
            raise facts.error(iri, f"a second afbit of the same category and {afbit.feature}")
        found[key] = afbit
    return tuple(found[key] for key in sorted(found))


def _afbit(facts: Facts, iri: str, category: str) -> Afbit:
    return Afbit(
        **common(facts, iri),
        category=category,
        feature=fragment(facts.text(iri, "ofFeature")),
        strength=facts.probability(iri, "strength"),
        part=name_or_none(facts.one(iri, "ofPart")),
        pose=name_or_none(facts.one(iri, "pose")),
        scale=name_or_none(facts.one(iri, "scale")),
        rules=tuple(fragment(rule) for rule in facts.many(iri, "byRule")),
        independent_sources=int(facts.number(iri, "independentSources", default=0)),
        reviewed=facts.text(iri, "reviewed", default="false") == "true",
    )


def read_categories(facts: Facts, afbits: Iterable[Afbit]) -> Mapping[str, Category]:
    """The object categories with what they afford as wholes, by name."""
    whole = {
        fragment(iri)
        for iri in facts.of_type("ObjectPart")
        if facts.text(iri, "whole", default="false") == "true"
    }
    strengths: dict[str, dict[str, float]] = {}
    for afbit in afbits:
        if afbit.part is None or afbit.part in whole:
            of_category = strengths.setdefault(afbit.category, {})
            of_category[afbit.feature] = max(afbit.strength, of_category.get(afbit.feature, 0.0))
    rates = _report_rates(facts)

    def read(facts: Facts, iri: str) -> Category:
        return _category(facts, iri, strengths.get(fragment(iri), {}), rates.get(iri, {}))

    return read_all(facts, "ObjectCategory", read)


def _report_rates(facts: Facts) -> dict[str, dict[str, float]]:
    rates: dict[str, dict[str, float]] = {}
    for iri in facts.of_type("ReportRate"):
        of_category = rates.setdefault(facts.text(iri, "ofCategory"), {})
        of_category[fragment(facts.text(iri, "ofFeature"))] = facts.probability(iri, "rate")
    return rates


def _category(
    facts: Facts, iri: str, afbits: dict[str, float], rates: dict[str, float]
) -> Category:
    moved = name_or_none(facts.one(iri, "moved"))
    return Category(
        **common(facts, iri),
        broader=name_or_none(facts.one(iri, SKOS + "broader")),
        entity_class=facts.one(iri, "entityClass"),
        scale=fragment(facts.text(iri, "scale")),
        stands_on=facts.text(iri, "standsOn", default="Anything"),
        length_m=range_of(facts, iri, "length", required=True),
        width_m=range_of(facts, iri, "width", required=True),
        height_m=range_of(facts, iri, "height", required=True),
        top_height_m=range_or_none(facts, iri, "top"),
        movability=_movability(facts, iri, moved),
        matching_weight=facts.probability(iri, "matchingWeight"),
        expected_number=positive(facts, iri, "expectedNumber"),
        afbits=MappingProxyType(dict(sorted(afbits.items()))),
        definition=facts.text(iri, SKOS + "definition", default=""),
        underside_m=range_or_none(facts, iri, "underside"),
        mass_kg=range_or_none(facts, iri, "mass"),
        moved=moved,
        shape=name_or_none(facts.one(iri, "shape")),
        materials=tuple(fragment(m) for m in facts.many(iri, "madeOf")),
        traits=tuple(fragment(t) for t in facts.many(iri, "hasTrait")),
        report_rates=MappingProxyType(dict(sorted(rates.items()))),
    )


def _movability(facts: Facts, iri: str, moved: str | None) -> str:
    default = movability_of(moved) if moved else None
    movability = fragment(facts.text(iri, "movability", default=default))
    if movability not in ("Static", "Dynamic"):
        raise facts.error(iri, f"movability {movability} is neither Static nor Dynamic")
    return movability
