"""Checks that what the ontology refers to exists, so that no error surfaces later, elsewhere."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from afkb.knowledge.facts import Facts
from afkb.ontology.names import SOMETHING_ELSE, UNKNOWN_ROOM, fragment

if TYPE_CHECKING:
    from afkb.knowledge.content import Content

PARAMETERS = (
    "AfbitLeak",
    "BoardsSeen",
    "FaintestHypothesis",
    "HeightNoise",
    "ShareSeenHalf",
    "ShareSeenLittle",
    "ShareSeenMost",
    "SizeBlur",
    "SizeNoise",
    "SizeSpread",
    "StandsAsTypical",
    "StrayShare",
    "SupportSeen",
    "UnknownBreadth",
    "UnknownRoomBreadth",
)
"""The numbers that the network needs, each an individual of `afn:NetworkParameter`."""

_Reference = tuple[str, str, str | None, Container[str]]
"""IRI of the statement, what kind of thing it names, the name, the names that exist."""


def check_references(content: Content, facts: Facts) -> None:
    """Raise `KnowledgeError`, with the file, for the first reference to an unknown term."""
    for iri, kind, name, known in _references(content, facts):
        if name is not None and name not in known:
            raise facts.error(iri, f"{kind} {name} is not in the ontology")
    _require(facts, "ObjectCategory", content.categories, [SOMETHING_ELSE])
    _require(facts, "RoomCategory", content.rooms, [UNKNOWN_ROOM])
    _require(facts, "NetworkParameter", content.parameters, PARAMETERS)
    _check_cycles(content, facts)


def _references(content: Content, facts: Facts) -> Iterator[_Reference]:
    features, scales = content.features, content.scales
    measures = {measure.measure_name for measure in content.measures.values()}
    for feature in features.values():
        yield feature.iri, "feature", feature.broader, features
        for name in feature.parameters:
            yield feature.iri, "measure", name, measures or (name,)
    for category in content.categories.values():
        yield category.iri, "scale", category.scale, scales
    for afbit in facts.of_type("Afbit"):
        yield afbit, "feature", fragment(facts.text(afbit, "ofFeature")), features
    for dual in content.duals:
        yield dual.iri, "feature", dual.evidence, features
        yield dual.iri, "feature", dual.predicted, features
        yield dual.iri, "scale", dual.predicted_scale, scales
    for pair in content.co_occurrences:
        yield pair.iri, "feature", pair.feature, features
        yield pair.iri, "scale", pair.predicted_scale, scales
        yield pair.iri, "evidence class", pair.evidence_class, content.evidence_classes
        yield pair.iri, "evidence class", pair.predicted_class, content.evidence_classes
        yield pair.iri, "category", pair.evidence_category, content.categories
        yield pair.iri, "category", pair.predicted_category, content.categories
    for placed in content.objects_in_rooms:
        yield placed.iri, "category", placed.category, content.categories
        yield placed.iri, "room", placed.room, content.rooms
    for together in content.objects_with_objects:
        yield together.iri, "category", together.category, content.categories
        yield together.iri, "category", together.given, content.categories
    for put in content.objects_on_supports:
        yield put.iri, "category", put.category, content.categories
        yield put.iri, "category", put.given, content.categories
    for evidence in content.evidence_classes.values():
        yield evidence.iri, "feature", evidence.feature, features
    for room in content.rooms.values():
        for name in room.expected_counts:
            yield room.iri, "evidence class", name, content.evidence_classes


def _require(
    facts: Facts, class_name: str, found: Mapping[str, object], names: Iterable[str]
) -> None:
    for name in names:
        if name not in found:
            raise facts.error(name, f"missing; the network needs this {class_name}")


def _check_cycles(content: Content, facts: Facts) -> None:
    for feature in content.features.values():
        seen = {feature.name}
        broader = feature.broader
        while broader is not None:
            if broader in seen:
                raise facts.error(feature.iri, f"is broader than itself by way of {broader}")
            seen.add(broader)
            broader = content.features[broader].broader
