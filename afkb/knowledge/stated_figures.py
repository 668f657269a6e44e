"""Figures that were counted in homes, as the ontology states them, and how they are read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from afkb.knowledge.facts import Facts
from afkb.knowledge.item_reading import common
from afkb.knowledge.model import Statement
from afkb.ontology.names import fragment


@dataclass(frozen=True, slots=True)
class StatedFigure(Statement):
    """P(a thing of the category | …), smoothed; `successes` of `trials` are behind it."""

    category: str
    probability: float
    successes: float
    trials: float


@dataclass(frozen=True, slots=True)
class ObjectInRoom(StatedFigure):
    """P(a room of that category holds such a thing); `mean_number`: how many, on average."""

    room: str
    mean_number: float


@dataclass(frozen=True, slots=True)
class ObjectWithObject(StatedFigure):
    """P(a room that holds the given category holds such a thing, too) (paper §II.D.iii)."""

    given: str


@dataclass(frozen=True, slots=True)
class ObjectOnSupport(StatedFigure):
    """P(what the given thing is put on is of the category | it is put on something)."""

    given: str


def read_object_in_room(facts: Facts, iri: str) -> ObjectInRoom:
    """One figure of what rooms hold."""
    probability = facts.probability(iri, "probability")
    mean_number = facts.number(iri, "meanNumber", default=probability)
    if mean_number < 0:
        raise facts.error(iri, f"meanNumber {mean_number} is negative")
    return ObjectInRoom(
        **common(facts, iri),
        category=fragment(facts.text(iri, "ofCategory")),
        room=fragment(facts.text(iri, "ofRoom")),
        probability=probability,
        mean_number=mean_number,
        successes=facts.number(iri, "successes", default=0.0),
        trials=facts.number(iri, "trials", default=0.0),
    )


def read_object_with_object(facts: Facts, iri: str) -> ObjectWithObject:
    """One figure of what is found together in a room."""
    return _given(ObjectWithObject, facts, iri)


def read_object_on_support(facts: Facts, iri: str) -> ObjectOnSupport:
    """One figure of what things are put on."""
    return _given(ObjectOnSupport, facts, iri)


G = TypeVar("G", ObjectWithObject, ObjectOnSupport)


def _given(kind: type[G], facts: Facts, iri: str) -> G:
    return kind(
        **common(facts, iri),
        category=fragment(facts.text(iri, "ofCategory")),
        given=fragment(facts.text(iri, "givenCategory")),
        probability=facts.probability(iri, "probability"),
        successes=facts.number(iri, "successes", default=0.0),
        trials=facts.number(iri, "trials", default=0.0),
    )
