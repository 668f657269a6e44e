"""Reads rooms with what they hold, duals and co-occurrences: what tells of what."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TypedDict

from afkb.knowledge.facts import Facts
from afkb.knowledge.item_reading import common, name_or_none, positive, range_of, read_all
from afkb.knowledge.model import CoOccurrence, Dual, EvidenceClass, Range, RoomCategory
from afkb.ontology.names import RELATIONS, fragment


def read_rooms(facts: Facts) -> Mapping[str, RoomCategory]:
    """The room categories with their expected counts, by name."""
    counts: dict[str, dict[str, float]] = {}
    for iri in facts.of_type("RoomEvidence"):
        room = facts.text(iri, "ofRoom")
        evidence = fragment(facts.text(iri, "ofEvidenceClass"))
        of_room = counts.setdefault(room, {})
        if evidence in of_room:
            raise facts.error(iri, f"a second count of the same room and {evidence}")
        of_room[evidence] = positive(facts, iri, "expectedCount")
    for room in sorted(set(counts) - set(facts.of_type("RoomCategory"))):
        raise facts.error(room, "has expected counts but is no room category")
    return read_all(facts, "RoomCategory", lambda f, iri: _room(f, iri, counts.get(iri, {})))


def _room(facts: Facts, iri: str, counts: dict[str, float]) -> RoomCategory:
    return RoomCategory(
        **common(facts, iri),
        expected_number=positive(facts, iri, "expectedNumber"),
        expected_counts=MappingProxyType(dict(sorted(counts.items()))),
    )


def read_evidence_class(facts: Facts, iri: str) -> EvidenceClass:
    """One evidence class."""
    return EvidenceClass(
        **common(facts, iri),
        feature=fragment(facts.text(iri, "ofFeature")),
        length_m=range_of(facts, iri, "length"),
        width_m=range_of(facts, iri, "width"),
        top_height_m=range_of(facts, iri, "top"),
        dispersion=positive(facts, iri, "dispersion", default=1.0),
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
        **common(facts, iri),
        **_relationship(facts, iri),
        evidence=fragment(facts.text(iri, "evidence")),
        predicted=fragment(facts.text(iri, "predicted")),
        relation=relation,
        evidence_bottom_min_m=facts.number(iri, "evidenceBottomMin", default=-math.inf),
    )


def read_co_occurrence(facts: Facts, iri: str) -> CoOccurrence:
    """One co-occurrence, a rule or a listed pair."""
    names = {
        key: name_or_none(facts.one(iri, prop))
        for key, prop in (
            ("evidence_class", "evidenceClass"),
            ("predicted_class", "predictedClass"),
            ("evidence_category", "evidenceCategory"),
            ("predicted_category", "predictedCategory"),
        )
    }
    item = CoOccurrence(
        **common(facts, iri),
        **_relationship(facts, iri),
        feature=fragment(facts.text(iri, "ofFeature")),
        **names,
    )
    if not item.is_rule and (item.evidence_category is None or item.predicted_category is None):
        raise facts.error(iri, "names neither two evidence classes nor two categories")
    return item
