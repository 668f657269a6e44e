"""Everything an ontology states, read and checked at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TypeVar

from afkb.knowledge.consistency import check_references
from afkb.knowledge.facts import Facts, read_facts
from afkb.knowledge.item_reading import read_all
from afkb.knowledge.model import (
    Afbit,
    Category,
    CoOccurrence,
    Dual,
    EvidenceClass,
    Feature,
    Measure,
    RoomCategory,
    Scale,
)
from afkb.knowledge.relation_reading import (
    read_co_occurrence,
    read_dual,
    read_evidence_class,
    read_rooms,
)
from afkb.knowledge.stated_figures import (
    ObjectInRoom,
    ObjectOnSupport,
    ObjectWithObject,
    StatedFigure,
    read_object_in_room,
    read_object_on_support,
    read_object_with_object,
)
from afkb.knowledge.thing_reading import (
    read_afbits,
    read_categories,
    read_features,
    read_measure,
    read_scale,
)
from afkb.ontology.names import AFN, fragment

T = TypeVar("T", bound=StatedFigure)


@dataclass(frozen=True, slots=True)
class Content:
    """The typed items by name, the network's numbers, and the IRI of every name."""

    features: Mapping[str, Feature]
    measures: Mapping[str, Measure]
    scales: Mapping[str, Scale]
    categories: Mapping[str, Category]
    afbits: tuple[Afbit, ...]
    duals: tuple[Dual, ...]
    co_occurrences: tuple[CoOccurrence, ...]
    evidence_classes: Mapping[str, EvidenceClass]
    rooms: Mapping[str, RoomCategory]
    objects_in_rooms: tuple[ObjectInRoom, ...]
    objects_with_objects: tuple[ObjectWithObject, ...]
    objects_on_supports: tuple[ObjectOnSupport, ...]
    parameters: Mapping[str, float]
    iris: Mapping[str, str]


def read_content(files: Sequence[Path]) -> Content:
    """Read the files and check that what they refer to exists; `KnowledgeError` with the file."""
    facts = read_facts(files)
    scales = read_all(facts, "Scale", read_scale)
    duals = read_all(facts, "Dual", read_dual)
    pairs = read_all(facts, "CoOccurrence", read_co_occurrence)
    afbits = read_afbits(facts)
    content = Content(
        features=read_features(facts),
        measures=read_all(facts, "Measure", read_measure),
        scales=MappingProxyType(dict(sorted(scales.items(), key=lambda s: s[1].extent_m))),
        categories=read_categories(facts, afbits),
        afbits=afbits,
        duals=tuple(duals[name] for name in sorted(duals)),
        co_occurrences=tuple(pairs[name] for name in sorted(pairs)),
        evidence_classes=read_all(facts, "EvidenceClass", read_evidence_class),
        rooms=read_rooms(facts),
        objects_in_rooms=_best_counted(facts, "ObjectInRoom", read_object_in_room),
        objects_with_objects=_best_counted(facts, "ObjectWithObject", read_object_with_object),
        objects_on_supports=_best_counted(facts, "ObjectOnSupport", read_object_on_support),
        parameters=MappingProxyType(
            {
                name: facts.number(iri, "value")
                for name, iri in _by_name(facts, "NetworkParameter").items()
            }
        ),
        iris=MappingProxyType(_all_names(facts)),
    )
    check_references(content, facts)
    return content


def _best_counted(facts: Facts, class_name: str, read: Callable[[Facts, str], T]) -> tuple[T, ...]:
    """Every figure of a class; of those with one name, an extension's, else the one read first.

    An extension's figures are of its user's own homes, refitted from those of the ontology.
    """
    best: dict[str, T] = {}
    for iri in facts.of_type(class_name):
        item = read(facts, iri)
        if item.name not in best or best[item.name].iri.startswith(AFN):
            best[item.name] = item
    return tuple(best[name] for name in sorted(best))


def _by_name(facts: Facts, class_name: str) -> dict[str, str]:
    return {fragment(iri): iri for iri in facts.of_type(class_name)}


def _all_names(facts: Facts) -> dict[str, str]:
    """Name to IRI; where two namespaces share a name, the one that was read first keeps it."""
    names: dict[str, str] = {}
    for iri in facts.values:
        names.setdefault(fragment(iri), iri)
    return names
