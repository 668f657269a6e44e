"""All that a scene states, by thing and property: for reading a whole map at once."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cache

from pyoxigraph import Literal, NamedNode, Store

from afkb.store.stored import natural, points
from afkb.store.vocabulary import local_name, term

Value = NamedNode | Literal
Said = dict[str, list[Value]]
_NOTHING: Said = {}
_TYPE = term("rdf:type").value


@cache
def _iri(curie: str) -> str:
    return term(curie).value


class Facts:
    """An index over a scene's statements; one pass over them, then no more queries."""

    def __init__(self, store: Store) -> None:
        said: defaultdict[str, Said] = defaultdict(dict)
        for quad in store:
            if isinstance(quad.subject, NamedNode) and isinstance(quad.object, Value):
                told = said[quad.subject.value]
                told.setdefault(quad.predicate.value, []).append(quad.object)
        self._said = dict(said)
        self._by_class: defaultdict[str, list[str]] = defaultdict(list)
        for iri, told in self._said.items():
            for kind in told.get(_TYPE, ()):
                self._by_class[kind.value].append(iri)

    def all(self, name: str) -> list[Thing]:
        """Everything of class `afn:<name>`, in order of id (`e2` before `e10`)."""
        found = [self.thing(iri) for iri in self._by_class[term(f"afn:{name}").value]]
        return sorted(found, key=lambda thing: natural(thing.id))

    def thing(self, iri: str) -> Thing:
        """The thing of that IRI; one of which nothing is stated has no values."""
        return Thing(self, iri, self._said.get(iri, _NOTHING))


@dataclass(frozen=True, slots=True)
class Thing:
    """One thing of a scene and what is stated of it; properties are named as `afn:x`."""

    facts: Facts
    iri: str
    said: Said

    @property
    def id(self) -> str:
        """The local part of its IRI, decoded."""
        return local_name(self.iri)

    def values(self, predicate: str) -> list[Value]:
        """All that is stated by a property, in no order."""
        return self.said.get(_iri(predicate), [])

    def number(self, predicate: str, default: float = 0.0) -> float:
        """A number, or the default."""
        return next((float(v.value) for v in self.values(predicate)), default)

    def maybe_number(self, predicate: str) -> float | None:
        """A number, or None."""
        return next((float(v.value) for v in self.values(predicate)), None)

    def whole(self, predicate: str) -> int:
        """A whole number, 0 if none is stated."""
        return int(self.number(predicate))

    def names(self, predicate: str) -> tuple[str, ...]:
        """Ids, or texts, in natural order: RDF keeps none."""
        found = (
            local_name(v.value) if isinstance(v, NamedNode) else v.value
            for v in self.values(predicate)
        )
        return tuple(sorted(found, key=natural))

    def name(self, predicate: str) -> str | None:
        """The one thing that is stated, or None."""
        return next(iter(self.names(predicate)), None)

    def flag(self, predicate: str, default: bool = True) -> bool:
        """A truth value, or the default."""
        told = self.name(predicate)
        return default if told is None else told == "true"

    def things(self, predicate: str) -> list[Thing]:
        """The things that a property points to, in order of id."""
        iris = [v.value for v in self.values(predicate) if isinstance(v, NamedNode)]
        found = [self.facts.thing(iri) for iri in iris]
        return sorted(found, key=lambda thing: natural(thing.id))

    def belief(self, kind: str, of: str) -> dict[str, float]:
        """A posterior `afn:<kind>Belief`, name to probability, the likeliest first."""
        found = [
            (belief.name(f"afn:{of}") or "", belief.number("afn:probability"))
            for belief in self.things(f"afn:{kind}Belief")
        ]
        return dict(sorted(found, key=lambda item: (-item[1], item[0])))

    def outline(self) -> list[list[float]]:
        """Its polygon or line, [[x, y], …] m in the map frame; empty where it has none."""
        for geometry in self.things("geo:hasGeometry"):
            for wkt in geometry.values("geo:asWKT"):
                return points(wkt.value)
        return []
