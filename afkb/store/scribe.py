"""Writes statements about the things of one scene; every thing and belief gets a name."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from pyoxigraph import Literal, NamedNode, Triple

from afkb.errors import AfkbError, MapError
from afkb.store.vocabulary import AFN, OTHER_NAMES, escaped, term

Value = NamedNode | Literal | str | float | int | bool

_ROUNDING = 1e-6
# The two answers that stand outside every ontology: a room or a thing of no category it knows.
_ELSEWHERE = ("UnknownRoom", "SomethingElse")


class Names(Protocol):
    """What the store asks of the knowledge base: IRIs of its terms, and the scale of a size."""

    def iri(self, name: str) -> str:
        """The IRI of a named individual."""
        ...

    def scale_of(self, size_xyz: tuple[float, float, float]) -> str:
        """Name of the scale of a thing of that size, m."""
        ...


def _number(value: float, digits: int) -> Literal:
    """A double rounded to what is meant, so that noise in the last bits changes no byte."""
    return Literal(round(float(value), digits) + 0.0)


class Scribe:
    """Collects triples about the things of one scene, whose IRIs start with `base`."""

    def __init__(self, base: str, names: Names) -> None:
        self.base = base
        self.triples: list[Triple] = []
        self._names = names

    def node(self, local: str) -> NamedNode:
        """The IRI of a thing of this scene."""
        return NamedNode(self.base + escaped(local))

    def individual(self, name: str) -> NamedNode:
        """The ontology's IRI for a name; for a name it lacks, another, described here."""
        if name in _ELSEWHERE:
            return NamedNode(AFN + name)
        try:
            return NamedNode(self._names.iri(name))
        except (KeyError, AfkbError):
            unknown = NamedNode(OTHER_NAMES + escaped(name))
            self.say(unknown, "rdfs:label", name)
            self.say(unknown, "rdfs:comment", "used by a plugin; no ontology in use describes it")
            return unknown

    def axiom(self, axiom: str) -> NamedNode:
        """A statement of the ontology by its IRI; what is no IRI is named in this scene."""
        is_iri = "://" in axiom or axiom.startswith("urn:")
        return NamedNode(axiom) if is_iri else self.node(axiom)

    def makers(self, names: Iterable[str]) -> list[NamedNode]:
        """The activities of detectors, predictors or rules in this run."""
        return [self.node(f"by-{name}") for name in names]

    def scale_of(self, size_xyz: tuple[float, float, float]) -> NamedNode:
        """The IRI of the scale of a thing of that size, m."""
        return self.individual(self._names.scale_of(size_xyz))

    def say(self, subject: NamedNode, predicate: str, *values: Value | None) -> None:
        """State one value or several; None says nothing; floats are doubles, to 0.1 mm or 1e-4."""
        for value in values:
            if value is None:
                continue
            if isinstance(value, float | np.floating) and not math.isfinite(value):
                raise MapError(f"{subject.value}: {predicate} is {value}; the mapper has a bug")
            said = value if isinstance(value, NamedNode | Literal) else _literal(value)
            self.triples.append(Triple(subject, term(predicate), said))

    def probability(self, subject: NamedNode, predicate: str, p: float) -> None:
        """State a probability, to 1e-9; `MapError` where it is not inside 0..1."""
        if not 0 <= p <= 1 + _ROUNDING:
            raise MapError(f"{subject.value}: {predicate} is {p}, not a probability")
        self.triples.append(Triple(subject, term(predicate), _number(min(p, 1.0), 9)))

    def belief(
        self, about: NamedNode, kind: str, of: str, beliefs: Iterable[tuple[str, float]]
    ) -> None:
        """State beliefs, each a node with a name: `about afn:<kind>Belief [afn:<of> …]`."""
        for name, p in beliefs:
            belief = NamedNode(f"{about.value}-{kind}-{escaped(name)}")
            self.say(about, f"afn:{kind}Belief", belief)
            self.say(belief, f"afn:{of}", self.individual(name))
            self.probability(belief, "afn:probability", p)

    def geometry(self, about: NamedNode, wkt: str) -> None:
        """State its outline in the map frame, as a GeoSPARQL geometry of its own."""
        geometry = NamedNode(about.value + "-geometry")
        self.say(about, "geo:hasGeometry", geometry)
        self.say(geometry, "rdf:type", term("geo:Geometry"))
        self.say(geometry, "geo:asWKT", Literal(wkt, datatype=term("geo:wktLiteral")))


def _literal(value: str | float | int | bool) -> Literal:
    if isinstance(value, float | np.floating):
        return _number(float(value), 4)
    if isinstance(value, np.integer):
        return Literal(int(value))
    return Literal(value)


def ranked(beliefs: Mapping[str, float], at_most: int | None = None) -> list[tuple[str, float]]:
    """Names with their probabilities, the likeliest first, equals by name."""
    return sorted(beliefs.items(), key=lambda item: (-item[1], item[0]))[:at_most]


def polygon_wkt(polygon_xy: NDArray[np.float64]) -> str:
    """Well-known text of an outline (N, 2) m, closed if it was not; fewer than 3 points a line."""
    points = [(round(float(x), 4) + 0.0, round(float(y), 4) + 0.0) for x, y in polygon_xy]
    if len(points) >= 3 and points[0] != points[-1]:
        points.append(points[0])
    text = ", ".join(f"{x} {y}" for x, y in points)
    return f"POLYGON (({text}))" if len(points) >= 4 else f"LINESTRING ({text})"
