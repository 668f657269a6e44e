"""What every item of the model is read with: its name and source, its ranges and numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TypedDict, TypeVar

from afkb.knowledge.facts import Facts
from afkb.knowledge.model import Range, Statement
from afkb.ontology.names import DCTERMS, RDFS_LABEL, fragment

T = TypeVar("T", bound=Statement)


class Common(TypedDict):
    """What every statement has."""

    name: str
    iri: str
    label: str
    status: str
    source: str
    place: str


def common(facts: Facts, iri: str) -> Common:
    """Name, label, status, source and place of an individual, filled where it has none."""
    name = fragment(iri)
    return Common(
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


def range_of(facts: Facts, iri: str, what: str, required: bool = False) -> Range:
    """The range that `<what>Min` and `<what>Max` state; without end where nothing does."""
    low = facts.number(iri, what + "Min", default=None if required else -math.inf)
    high = facts.number(iri, what + "Max", default=None if required else math.inf)
    if low > high:
        raise facts.error(iri, f"{what} from {low} to {high} is empty")
    return (low, high)


def range_or_none(facts: Facts, iri: str, what: str) -> Range | None:
    """The range, or None where neither end is stated."""
    ends = (facts.one(iri, what + "Min"), facts.one(iri, what + "Max"))
    return None if ends == (None, None) else range_of(facts, iri, what, required=True)


def positive(facts: Facts, iri: str, prop: str, default: float | None = None) -> float:
    """The value as a number above 0."""
    value = facts.number(iri, prop, default)
    if value <= 0:
        raise facts.error(iri, f"{prop} {value} is not above 0")
    return value


def name_or_none(iri: str | None) -> str | None:
    """The name of what an IRI stands for, if there is one."""
    return fragment(iri) if iri is not None else None
