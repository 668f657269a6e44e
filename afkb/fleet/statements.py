"""The statements of a map as a server gets them, and a digest that tells whether it has them."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Iterator, Sequence

from pyoxigraph import BlankNode, Literal, Triple

from afkb.errors import MapError
from afkb.store import StoredMap
from afkb.store.turtle import canonical
from afkb.store.vocabulary import PREFIXES, term

LONGEST_UPDATE = 256 * 1024
"""Characters of statements in one update: what servers take without being told to take more."""

_XSD = PREFIXES["xsd"]
_WHOLE = ("integer", "int", "long", "short", "byte", "nonNegativeInteger", "positiveInteger")
_NUMBERS = frozenset(_XSD + name for name in (*_WHOLE, "decimal", "double", "float"))


def statements_of(stored: StoredMap) -> list[Triple]:
    """All statements of a map in a fixed order, the one that says what it is last.

    So whoever finds that one in a graph that was filled in this order finds all.
    Raises `MapError` where one has a blank node: sent twice, it would be two.
    """
    ordered = canonical(quad.triple for quad in stored.store)
    if any(isinstance(node, BlankNode) for t in ordered for node in (t.subject, t.object)):
        raise MapError(f"{stored.folder}: has nodes without a name (blank nodes); map it again")
    seal = [t for t in ordered if _is_seal(t)]
    return [t for t in ordered if not _is_seal(t)] + seal


def _is_seal(triple: Triple) -> bool:
    return triple.predicate == term("rdf:type") and triple.object == term("afn:TopologicalMap")


def portions(statements: Sequence[Triple], longest: int = LONGEST_UPDATE) -> Iterator[list[str]]:
    """The statements as SPARQL has them, in portions of at most so many characters."""
    portion: list[str] = []
    size = 0
    for statement in statements:
        text = f"{statement} ."
        if portion and size + len(text) > longest:
            yield portion
            portion, size = [], 0
        portion.append(text)
        size += len(text) + 1
    if portion:
        yield portion


def digest_of(statements: Iterable[Triple]) -> str:
    """SHA-256 of what is stated, however a server writes its numbers (`1.50` or `1.5E0`)."""
    told = sorted({f"{t.subject} {t.predicate} {_meant(t.object)}" for t in statements})
    return hashlib.sha256("\n".join(told).encode()).hexdigest()


def _meant(value: object) -> str:
    """A number by its value; everything else as it is written."""
    if isinstance(value, Literal) and value.datatype.value in _NUMBERS:
        number = float(value.value)
        return repr(number + 0.0) if math.isfinite(number) else value.value
    return str(value)
