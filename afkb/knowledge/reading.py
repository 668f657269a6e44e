"""Turns the statements of the ontology into the typed items of the model."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import TypedDict, TypeVar

from afkb.knowledge.facts import Facts
from afkb.knowledge.model import (
    Afbit,
    Category,
    CoOccurrence,
    Dual,
    EvidenceClass,
    Feature,
    Range,
    RoomCategory,
    Scale,
    Statement,
    Trapezoid,
)
from afkb.ontology.categories import movability_of
from afkb.ontology.names import DCTERMS, KINDS, RDFS_LABEL, RELATIONS, SKOS, fragment

T = TypeVar("T", bound=Statement)


class _Common(TypedDict):
    name: str
    iri: str
    label: str
    status: str
    source: str
    place: str


def _common(facts: Facts, iri: str) -> _Common:
    name = fragment(iri)
    return _Common(
        name=name,
        iri=iri,
        label=facts.text(iri, RDFS_LABEL, default=name),
        status=facts.text(iri, "status", default="proposed"),
        source=facts.text(iri, DCTERMS + "source", default=str(facts.file_of[iri].name)),
        place=facts.text(iri, "fromRow", default=facts.file_of[iri].name),
    )


def read_all(facts: Facts, class_name: str, read: Callable[[Facts, str], T]) -> Mapping[str, T]:
    """Every individual of a class, read, by name; `KnowledgeError` where two share a name."""
    items: dict[str, T] = {}
    for iri in facts.of_type(class_name):
        item = read(facts, iri)
        if item.name in items:
            raise facts.error(iri, f"the name {item.name} is taken by {items[item.name].iri}")
        items[item.name] = item
    return MappingProxyType(items)


def read_features(facts: Facts) -> Mapping[str, Feature]:
    """The affordance features of all three kinds, by name."""
    trapezoids = facts.of_type("Trapezoid")
    features: dict[str, Feature] = {}
    for kind, class_name in KINDS.items():
        for iri in facts.of_type(class_name):
            features[fragment(iri)] = Feature(
                **_common(facts, iri),
                kind=kind,
                definition=facts.text(iri, SKOS + "definition", default=""),
                grounding=facts.text(iri, "grounding", default=""),
                broader=_maybe(facts.one(iri, SKOS + "broader")),
                parameters=MappingProxyType(
                    {
                        facts.text(t, "parameterName"): _trapezoid(facts, t)
                        for t in trapezoids
                        if facts.text(t, "ofFeature") == iri
                    }
                ),
            )
    return MappingProxyType(dict(sorted(features.items())))


def _trapezoid(facts: Facts, iri: str) -> Trapezoid:
    z1, n1, n2, z2 = (facts.number(iri, p) for p in ("z1", "n1", "n2", "z2"))
    if not z1 <= n1 <= n2 <= z2:
        raise facts.error(iri, f"z1, n1, n2, z2 = {z1}, {n1}, {n2}, {z2} do not rise")
    return Trapezoid(z1, n1, n2, z2)


def read_scale(facts: Facts, iri: str) -> Scale:
    """One scale."""
    return Scale(**_common(facts, iri), extent_m=_range(facts, iri, "extent"))


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
        **_common(facts, iri),
        category=category,
        feature=fragment(facts.text(iri, "ofFeature")),
        strength=facts.probability(iri, "strength"),
        part=_maybe(facts.one(iri, "ofPart")),
        pose=_maybe(facts.one(iri, "pose")),
        scale=_maybe(facts.one(iri, "scale")),
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
    moved = _maybe(facts.one(iri, "moved"))
    return Category(
        **_common(facts, iri),
        broader=_maybe(facts.one(iri, SKOS + "broader")),
        entity_class=facts.one(iri, "entityClass"),
        scale=fragment(facts.text(iri, "scale")),
        stands_on=facts.text(iri, "standsOn", default="Anything"),
        length_m=_range(facts, iri, "length", required=True),
        width_m=_range(facts, iri, "width", required=True),
        height_m=_range(facts, iri, "height", required=True),
        top_height_m=_range_or_none(facts, iri, "top"),
        movability=_movability(facts, iri, moved),
        matching_weight=facts.probability(iri, "matchingWeight"),
        expected_number=_positive(facts, iri, "expectedNumber"),
        afbits=MappingProxyType(dict(sorted(afbits.items()))),
        definition=facts.text(iri, SKOS + "definition", default=""),
        underside_m=_range_or_none(facts, iri, "underside"),
        mass_kg=_range_or_none(facts, iri, "mass"),
        moved=moved,
        shape=_maybe(facts.one(iri, "shape")),
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


def read_rooms(facts: Facts) -> Mapping[str, RoomCategory]:
    """The room categories with their expected counts, by name."""
    counts: dict[str, dict[str, float]] = {}
    for iri in facts.of_type("RoomEvidence"):
        room = facts.text(iri, "ofRoom")
        evidence = fragment(facts.text(iri, "ofEvidenceClass"))
        of_room = counts.setdefault(room, {})
        if evidence in of_room:
            raise facts.error(iri, f"a second count of the same room and {evidence}")
        of_room[evidence] = _positive(facts, iri, "expectedCount")
    for room in sorted(set(counts) - set(facts.of_type("RoomCategory"))):
        raise facts.error(room, "has expected counts but is no room category")
    return read_all(facts, "RoomCategory", lambda f, iri: _room(f, iri, counts.get(iri, {})))


def _room(facts: Facts, iri: str, counts: dict[str, float]) -> RoomCategory:
    return RoomCategory(
        **_common(facts, iri),
        expected_number=_positive(facts, iri, "expectedNumber"),
        expected_counts=MappingProxyType(dict(sorted(counts.items()))),
    )


def read_evidence_class(facts: Facts, iri: str) -> EvidenceClass:
    """One evidence class."""
    return EvidenceClass(
        **_common(facts, iri),
        feature=fragment(facts.text(iri, "ofFeature")),
        length_m=_range(facts, iri, "length"),
        width_m=_range(facts, iri, "width"),
        top_height_m=_range(facts, iri, "top"),
        dispersion=_positive(facts, iri, "dispersion", default=1.0),
    )


class _Relation(TypedDict):
    strength: float
    distance_m: Range
    size_xy_m: Range
    predicted_scale: str


def _relationship(facts: Facts, iri: str) -> _Relation:
    def non_negative(prop: str) -> float:
        value = facts.number(iri, prop, default=0.0)
        if value < 0:
            raise facts.error(iri, f"{prop} {value} is below 0")
        return value

    return _Relation(
        strength=facts.probability(iri, "strength"),
        distance_m=(non_negative("distanceMean"), non_negative("distanceSd")),
        size_xy_m=(non_negative("sizeXTypical"), non_negative("sizeYTypical")),
        predicted_scale=fragment(facts.text(iri, "predictedScale")),
    )


def read_dual(facts: Facts, iri: str) -> Dual:
    """One direction of an affordance dual."""
    relation = facts.text(iri, "relation")
    if relation not in RELATIONS:
        raise facts.error(iri, f"relation {relation!r} is none of: {', '.join(RELATIONS)}")
    return Dual(
        **_common(facts, iri),
        **_relationship(facts, iri),
        evidence=fragment(facts.text(iri, "evidence")),
        predicted=fragment(facts.text(iri, "predicted")),
        relation=relation,
        evidence_bottom_min_m=facts.number(iri, "evidenceBottomMin", default=-math.inf),
    )


def read_co_occurrence(facts: Facts, iri: str) -> CoOccurrence:
    """One co-occurrence, a rule or a listed pair."""
    names = {
        key: _maybe(facts.one(iri, prop))
        for key, prop in (
            ("evidence_class", "evidenceClass"),
            ("predicted_class", "predictedClass"),
            ("evidence_category", "evidenceCategory"),
            ("predicted_category", "predictedCategory"),
        )
    }
    item = CoOccurrence(
        **_common(facts, iri),
        **_relationship(facts, iri),
        feature=fragment(facts.text(iri, "ofFeature")),
        **names,
    )
    if not item.is_rule and (item.evidence_category is None or item.predicted_category is None):
        raise facts.error(iri, "names neither two evidence classes nor two categories")
    return item


def _range(facts: Facts, iri: str, what: str, required: bool = False) -> Range:
    low = facts.number(iri, what + "Min", default=None if required else -math.inf)
    high = facts.number(iri, what + "Max", default=None if required else math.inf)
    if low > high:
        raise facts.error(iri, f"{what} from {low} to {high} is empty")
    return (low, high)


def _range_or_none(facts: Facts, iri: str, what: str) -> Range | None:
    ends = (facts.one(iri, what + "Min"), facts.one(iri, what + "Max"))
    return None if ends == (None, None) else _range(facts, iri, what, required=True)


def _positive(facts: Facts, iri: str, prop: str, default: float | None = None) -> float:
    value = facts.number(iri, prop, default)
    if value <= 0:
        raise facts.error(iri, f"{prop} {value} is not above 0")
    return value


def _maybe(iri: str | None) -> str | None:
    return fragment(iri) if iri is not None else None
