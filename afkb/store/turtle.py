"""Turtle that is the same byte for byte for the same triples."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from pyoxigraph import RdfFormat, Triple, serialize

from afkb.store.vocabulary import PREFIXES

_TYPE = PREFIXES["rdf"] + "type"


def _order(triple: Triple) -> tuple[str, bool, str, str]:
    """By subject, its types first, then by predicate and object."""
    predicate = triple.predicate.value
    return str(triple.subject), predicate != _TYPE, predicate, str(triple.object)


def canonical(triples: Iterable[Triple]) -> list[Triple]:
    """The triples without doubles, in a fixed order."""
    return sorted(set(triples), key=_order)


def to_turtle(triples: Iterable[Triple], base: str) -> bytes:
    """Turtle of the triples, `scene:` bound to `base`; its order depends on nothing but them."""
    ordered = canonical(triples)
    text = "".join(map(str, ordered))
    used = {prefix: iri for prefix, iri in PREFIXES.items() if iri in text} | {"scene": base}
    written = serialize(ordered, format=RdfFormat.TURTLE, prefixes=used) or b""
    # The serializer lists prefixes in the order of a hash map, which changes from run to run.
    lines = written.split(b"\n")
    head = sorted(line for line in lines if line.startswith(b"@prefix "))
    return b"\n".join(head + lines[len(head) :])


def fingerprint(triples: Iterable[Triple]) -> str:
    """Sixteen hexadecimal digits that stand for the content of the triples."""
    digest = hashlib.sha256()
    for triple in canonical(triples):
        digest.update(str(triple).encode() + b"\n")
    return digest.hexdigest()[:16]
