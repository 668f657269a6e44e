"""Classes that an entity falls into by what it affords, its scale and its height alone.

Where these suffice to tell a category, its entity class is defined by them; where several
categories share them, a broader class of its own is (a desk and a table of one height look alike).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from rdflib import BNode, Graph, Literal, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS, SKOS, XSD
from rdflib.term import Node

from afkb.csv_rows import Row
from afkb.ontology.entity_classes import class_name
from afkb.ontology.names import AFN
from afkb.ontology.subjects import kinds_of

TABLE = "entity_definitions"


@dataclass(frozen=True, slots=True)
class EntityDefinition:
    """What an entity needs to be of a class.

    `features`: it affords all of them. `scale`: of that scale; empty for any. `z_m`: the range of
    `afn:z`: the height of the upward surface of what supports, else of the box's middle.
    """

    row: Row
    features: tuple[str, ...]
    scale: str
    z_m: tuple[float, float]

    @classmethod
    def read(cls, row: Row) -> EntityDefinition:
        """The definition of a row; `KnowledgeError`, with its place, where it says nothing."""
        features = tuple(row.several("features"))
        if not features:
            raise row.error("a definition needs at least one affordance; fill features")
        low, high = (
            row.number(column) if row.get(column) else end
            for column, end in (("z_min_m", -math.inf), ("z_max_m", math.inf))
        )
        if not low < high:
            raise row.error(f"z from {low} to {high}: expected min < max")
        return cls(row, features, row.get("scale"), (low, high))

    @property
    def name(self) -> str:
        """Name of the category, or of the new kind, that is defined."""
        return self.row["name"]

    def holds(self, thing: Typical) -> bool:
        """Whether the thing is of the class; a height that nobody knows may be any."""
        if not thing.features.issuperset(self.features) or self.scale not in ("", thing.scale):
            return False
        return thing.z_m is None or self.z_m[0] <= thing.z_m <= self.z_m[1]


@dataclass(frozen=True, slots=True)
class Typical:
    """A typical thing of a category, as a map would state it."""

    category: str
    features: frozenset[str]
    scale: str
    z_m: float | None


def typical_thing(row: Row, features: Iterable[str]) -> Typical:
    """The typical thing of a category's row that affords `features`: the middle of its ranges.

    What is put on other things has no height of its own.
    """
    afforded = frozenset(features)
    if not row.get("top_min_m") or row["stands_on"] in ("Support", "Anything"):
        return Typical(row["name"], afforded, row["scale"], None)
    top = (row.number("top_min_m") + row.number("top_max_m")) / 2
    height = (row.number("height_min_m") + row.number("height_max_m")) / 2
    z = top if "SupportAbility" in afforded else top - height / 2
    return Typical(row["name"], afforded, row["scale"], z)


def unsound(
    definitions: Iterable[EntityDefinition], things: Iterable[Typical], broader: Mapping[str, str]
) -> Iterator[str]:
    """What is wrong with definitions of categories, a line each: they must hold both ways.

    A typical thing that fits must be of the category or a narrower one, and every typical thing
    of those must fit. Definitions of other names say nothing of categories.
    """
    things = list(things)
    known = {thing.category for thing in things} | set(broader.values())
    for definition in definitions:
        if definition.name not in known:
            continue
        for thing in things:
            is_one = definition.name in kinds_of(thing.category, broader)
            if definition.holds(thing) and not is_one:
                yield f"{definition.row.place}: {thing.category} fits, and is no {definition.name}"
            if is_one and not definition.holds(thing):
                yield f"{definition.row.place}: {thing.category} is one, and does not fit"


def add_definitions(graph: Graph, definitions: Iterable[EntityDefinition]) -> None:
    """State each definition as `owl:equivalentClass`: an intersection of restrictions.

    A name that is no category's gets a class of its own. What affords a feature affords the
    broader ones, too: a property chain says so, so that a narrower feature fulfils a definition.
    """
    for definition in definitions:
        entity_class = URIRef(AFN + class_name(definition.name))
        if (entity_class, RDF.type, OWL.Class) not in graph:
            _describe(graph, entity_class, definition.row)
        for prop, text in ((URIRef(AFN + "status"), "status"), (DCTERMS.source, "source")):
            graph.add((entity_class, prop, _text(prop, definition.row[text])))
        graph.add((entity_class, URIRef(AFN + "fromRow"), _place(definition.row)))
        whole = BNode(f"{definition.name}.definition")
        graph.add((entity_class, OWL.equivalentClass, whole))
        graph.add((whole, RDF.type, OWL.Class))
        conjuncts = _conjuncts(graph, definition)
        graph.add((whole, OWL.intersectionOf, _list(graph, f"{definition.name}.of", conjuncts)))
    affords = URIRef(AFN + "affords")
    chain = _list(graph, "affords.chain", [affords, SKOS.broader])
    graph.add((affords, OWL.propertyChainAxiom, chain))


def _describe(graph: Graph, entity_class: URIRef, row: Row) -> None:
    graph.add((entity_class, RDF.type, OWL.Class))
    graph.add((entity_class, RDFS.subClassOf, URIRef(AFN + "Entity")))
    graph.add((entity_class, RDFS.label, Literal(f"{row['label']} (entity)", lang="en")))
    graph.add((entity_class, SKOS.definition, Literal(row["definition"], lang="en")))
    graph.add((entity_class, SKOS.example, Literal(row["example"], lang="en")))


def _text(prop: URIRef, text: str) -> Literal:
    plain = prop != DCTERMS.source
    return Literal(text, datatype=XSD.string) if plain else Literal(text, lang="en")


def _place(row: Row) -> Literal:
    return Literal(row.place, datatype=XSD.string)


def _conjuncts(graph: Graph, definition: EntityDefinition) -> list[Node]:
    name = definition.name
    conjuncts: list[Node] = [URIRef(AFN + "Entity")]
    conjuncts += [_has_value(graph, name, "affords", feature) for feature in definition.features]
    if definition.scale:
        conjuncts.append(_has_value(graph, name, "scale", definition.scale))
    if definition.z_m != (-math.inf, math.inf):
        conjuncts.append(_height(graph, name, definition.z_m))
    return conjuncts


def _has_value(graph: Graph, name: str, prop: str, value: str) -> BNode:
    node = BNode(f"{name}.{prop}.{value}")
    graph.add((node, RDF.type, OWL.Restriction))
    graph.add((node, OWL.onProperty, URIRef(AFN + prop)))
    graph.add((node, OWL.hasValue, URIRef(AFN + value)))
    return node


def _height(graph: Graph, name: str, z_m: tuple[float, float]) -> BNode:
    node, data_range = BNode(f"{name}.z"), BNode(f"{name}.z.range")
    graph.add((node, RDF.type, OWL.Restriction))
    graph.add((node, OWL.onProperty, URIRef(AFN + "z")))
    graph.add((node, OWL.someValuesFrom, data_range))
    graph.add((data_range, RDF.type, RDFS.Datatype))
    graph.add((data_range, OWL.onDatatype, XSD.double))
    facets: list[Node] = []
    for facet, limit in zip((XSD.minInclusive, XSD.maxInclusive), z_m, strict=True):
        if math.isfinite(limit):
            facets.append(BNode(f"{name}.z.{len(facets)}"))
            graph.add((facets[-1], facet, Literal(repr(limit), datatype=XSD.double)))
    graph.add((data_range, OWL.withRestrictions, _list(graph, f"{name}.z.facets", facets)))
    return node


def _list(graph: Graph, name: str, items: Sequence[Node]) -> BNode:
    """An RDF list whose nodes have telling names, so that the file is the same every time."""
    nodes = [BNode(f"{name}.{i}") for i in range(len(items))]
    for node, item, rest in zip(nodes, items, [*nodes[1:], RDF.nil], strict=True):
        graph.add((node, RDF.first, item))
        graph.add((node, RDF.rest, rest))
    return nodes[0]
