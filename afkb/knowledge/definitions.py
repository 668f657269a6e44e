"""What an ontology says that a map's things are classified by, read from a store."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from pyoxigraph import BlankNode, Literal, NamedNode, Store

from afkb.ontology.names import AFN, OWL, RDF, RDFS, SKOS, XSD

_THING = NamedNode(OWL + "Thing")
SUBCLASS = NamedNode(RDFS + "subClassOf")
BROADER = NamedNode(SKOS + "broader")
Limits = tuple[float, float]
AFFORDS, SCALE, Z = (NamedNode(AFN + name) for name in ("affords", "scale", "z"))


def links(store: Store, predicate: NamedNode) -> dict[str, list[str]]:
    """IRI to the IRIs that a property gives it, in every graph, but for `owl:Thing`."""
    found: dict[str, list[str]] = defaultdict(list)
    for quad in store.quads_for_pattern(None, predicate, None, None):
        subject, value = quad.subject, quad.object
        if isinstance(subject, NamedNode) and isinstance(value, NamedNode) and value != _THING:
            found[subject.value].append(value.value)
    return dict(found)


def upwards(name: str, steps: Mapping[str, list[str]]) -> list[str]:
    """Everything above a name, itself left out; stops where a cycle closes."""
    found: dict[str, None] = {}
    waiting = list(steps.get(name, ()))
    while waiting:
        above = waiting.pop()
        if above not in found and above != name:
            found[above] = None
            waiting += steps.get(above, ())
    return sorted(found)


@dataclass(slots=True)
class ThingFacts:
    """What is known of one thing: classes, affordances, scales, and ranges its height is in, m."""

    types: set[str]
    affords: set[str]
    scales: set[str]
    z_m: set[Limits]

    @property
    def count(self) -> int:
        """How many facts there are: it stays the same once nothing new follows."""
        return len(self.types) + len(self.affords) + len(self.scales) + len(self.z_m)


@dataclass(frozen=True, slots=True)
class DefinedClass:
    """A class and all that makes a thing one: classes, affordances, scales, ranges of z."""

    name: str
    classes: frozenset[str]
    affords: frozenset[str]
    scales: frozenset[str]
    z_m: frozenset[Limits]

    def apply(self, facts: ThingFacts) -> None:
        """Add the class to a thing that fulfils it, and all it asks for to a thing of the class."""
        if self.name in facts.types:
            facts.types |= self.classes
            facts.affords |= self.affords
            facts.scales |= self.scales
            facts.z_m |= self.z_m
        elif self._holds(facts):
            facts.types.add(self.name)

    def _holds(self, facts: ThingFacts) -> bool:
        return (
            self.affords <= facts.affords
            and self.classes <= facts.types
            and self.scales <= facts.scales
            and all(
                any(low <= least and most <= high for least, most in facts.z_m)
                for low, high in self.z_m
            )
        )


@dataclass(frozen=True, slots=True)
class Definitions:
    """What an ontology says that a map's things are classified by.

    `above`: class to all classes above it. `broader`: feature to all broader ones. `implied`:
    class to the features that its things afford. `domains`, `ranges`: property to classes.
    `entity_classes`: category to the class of its entities.
    """

    above: Mapping[str, list[str]]
    broader: Mapping[str, list[str]]
    implied: Mapping[str, frozenset[str]]
    domains: Mapping[str, list[str]]
    ranges: Mapping[str, list[str]]
    entity_classes: Mapping[str, list[str]]
    defined: tuple[DefinedClass, ...]

    @classmethod
    def read(cls, store: Store) -> Definitions:
        """What the ontology in a store says, closed or not."""
        steps, broader = links(store, SUBCLASS), links(store, BROADER)
        return cls(
            above={name: upwards(name, steps) for name in steps},
            broader={name: upwards(name, broader) for name in broader},
            implied=_implied(store),
            domains=links(store, NamedNode(RDFS + "domain")),
            ranges=links(store, NamedNode(RDFS + "range")),
            entity_classes=links(store, NamedNode(AFN + "entityClass")),
            defined=tuple(_definitions(store)),
        )


def _implied(store: Store) -> dict[str, frozenset[str]]:
    """Class to the affordances that a restriction says all its things have."""
    found: dict[str, set[str]] = defaultdict(set)
    for quad in store.quads_for_pattern(None, SUBCLASS, None, None):
        if isinstance(quad.object, BlankNode) and isinstance(quad.subject, NamedNode):
            feature = _value_of(store, quad.object, AFFORDS)
            if feature is not None:
                found[quad.subject.value].add(feature)
    return {name: frozenset(features) for name, features in found.items()}


def _definitions(store: Store) -> Iterator[DefinedClass]:
    """The classes that are equivalent to an intersection of what this module understands."""
    for quad in store.quads_for_pattern(None, NamedNode(OWL + "equivalentClass"), None, None):
        if not isinstance(quad.subject, NamedNode) or not isinstance(quad.object, BlankNode):
            continue
        members = _one(store, quad.object, OWL + "intersectionOf")
        definition = _read_definition(store, quad.subject.value, _items(store, members))
        if definition is not None:
            yield definition


def _read_definition(store: Store, name: str, members: Iterable[object]) -> DefinedClass | None:
    classes, affords, scales, ranges = set(), set(), set(), []
    for member in members:
        if isinstance(member, NamedNode):
            classes.add(member.value)
        elif not isinstance(member, BlankNode):
            return None
        elif feature := _value_of(store, member, AFFORDS):
            affords.add(feature)
        elif scale := _value_of(store, member, SCALE):
            scales.add(scale)
        elif (limits := _limits(store, member)) is not None:
            ranges.append(limits)
        else:
            return None
    if not affords | classes:
        return None
    return DefinedClass(
        name, frozenset(classes), frozenset(affords), frozenset(scales), frozenset(ranges)
    )


def _value_of(store: Store, restriction: BlankNode, prop: NamedNode) -> str | None:
    if _one(store, restriction, OWL + "onProperty") != prop:
        return None
    value = _one(store, restriction, OWL + "hasValue")
    return value.value if isinstance(value, NamedNode) else None


def _limits(store: Store, restriction: BlankNode) -> Limits | None:
    """The range of z that a restriction asks for, ends included."""
    if _one(store, restriction, OWL + "onProperty") != Z:
        return None
    data_range = _one(store, restriction, OWL + "someValuesFrom")
    facets = _one(store, data_range, OWL + "withRestrictions")
    low, high = float("-inf"), float("inf")
    for facet in _items(store, facets):
        least, most = (_one(store, facet, XSD + f"{end}Inclusive") for end in ("min", "max"))
        low = max(low, float(least.value)) if isinstance(least, Literal) else low
        high = min(high, float(most.value)) if isinstance(most, Literal) else high
    return (low, high) if (low, high) != (float("-inf"), float("inf")) else None


def _one(store: Store, subject: object, predicate: str) -> object:
    if not isinstance(subject, NamedNode | BlankNode):
        return None
    quads = store.quads_for_pattern(subject, NamedNode(predicate), None, None)
    return next((quad.object for quad in quads), None)


def _items(store: Store, node: object) -> Iterator[object]:
    while node is not None and node != NamedNode(RDF + "nil"):
        yield _one(store, node, RDF + "first")
        node = _one(store, node, RDF + "rest")
