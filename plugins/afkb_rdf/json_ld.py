"""JSON-LD of a scene, one thing a line, in a fixed order.

Each property is a term of the context, which says what its values are: another thing, a double, a
geometry. So values are plain JSON numbers, texts and names.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable

from pyoxigraph import Literal, NamedNode, Triple

from afkb.store.turtle import canonical
from afkb.store.vocabulary import PREFIXES, local_name

Json = dict[str, object]
Kind = tuple[str, str]

_XSD = PREFIXES["xsd"]
_TYPE = PREFIXES["rdf"] + "type"
_NATIVE = {_XSD + "string", _XSD + "boolean", _XSD + "integer"}
"""Datatypes that JSON-LD reads from plain JSON values without being told."""


def to_json_ld(triples: Iterable[Triple]) -> str:
    """The text of a JSON-LD document of named things, the same for the same triples."""
    ordered = canonical(triples)
    bases = PREFIXES | _scene_prefix(ordered)
    prefixes = {base: prefix for prefix, base in bases.items()}
    kinds = _kinds_of_properties(ordered)
    terms = _terms(kinds)
    things: dict[str, Json] = {}
    for triple in ordered:
        assert isinstance(triple.subject, NamedNode)
        thing = things.setdefault(
            triple.subject.value, {"@id": _compact(triple.subject.value, prefixes)}
        )
        _state(thing, triple, kinds[triple.predicate.value], terms, prefixes)
    context: Json = dict(bases)
    for iri, term in sorted(terms.items(), key=lambda item: item[1]):
        context[term] = _definition(iri, kinds[iri], prefixes)
    lines = ",\n".join(json.dumps(t, ensure_ascii=False) for t in things.values())
    head = json.dumps(context, indent=1, ensure_ascii=False)
    return f'{{"@context": {head},\n"@graph": [\n{lines}\n]}}\n'


def _scene_prefix(triples: list[Triple]) -> dict[str, str]:
    """`scene:` for the namespace of the map's own things."""
    for triple in triples:
        kind, about = triple.object, triple.subject
        if isinstance(kind, NamedNode) and local_name(kind.value) == "TopologicalMap":
            assert isinstance(about, NamedNode)
            return {"scene": about.value.rsplit("#", 1)[0] + "#"}
    return {}


def _kind(value: object) -> Kind:
    """What a value is: a thing, a text in a language, or a literal of some datatype."""
    if isinstance(value, NamedNode):
        return "@id", ""
    assert isinstance(value, Literal)
    return ("@language", value.language) if value.language else ("@type", value.datatype.value)


def _kinds_of_properties(triples: list[Triple]) -> dict[str, Kind | None]:
    """Each property with what all of its values are, or None where they differ."""
    found: defaultdict[str, set[Kind]] = defaultdict(set)
    for triple in triples:
        found[triple.predicate.value].add(_kind(triple.object))
    return {iri: next(iter(kinds)) if len(kinds) == 1 else None for iri, kinds in found.items()}


def _terms(properties: Iterable[str]) -> dict[str, str]:
    """Each property's short name; where two would have the same, none has it."""
    named: defaultdict[str, list[str]] = defaultdict(list)
    for iri in properties:
        if iri != _TYPE:
            named[local_name(iri)].append(iri)
    taken = set(PREFIXES) | {"scene"}
    return {
        iri: name if len(iris) == 1 and name not in taken else iri
        for name, iris in named.items()
        for iri in iris
    }


def _definition(iri: str, kind: Kind | None, prefixes: dict[str, str]) -> object:
    """How the context explains a term."""
    told = {"@id": _compact(iri, prefixes)}
    if kind is None or kind[0] == "@language" or kind[1] in _NATIVE:
        return told["@id"]
    return told | {"@type": "@id" if kind[0] == "@id" else _compact(kind[1], prefixes)}


def _state(
    thing: Json, triple: Triple, kind: Kind | None, terms: dict[str, str], prefixes: dict[str, str]
) -> None:
    """Add one statement to a thing; several values of a property become a list."""
    predicate = triple.predicate.value
    if predicate == _TYPE:
        assert isinstance(triple.object, NamedNode)
        key = "@type"
        value: object = _compact(triple.object.value, prefixes)
    else:
        key = terms[predicate]
        value = _value(triple.object, kind, prefixes)
    if key not in thing:
        thing[key] = value
    elif isinstance(there := thing[key], list):
        there.append(value)
    else:
        thing[key] = [there, value]


def _value(value: object, kind: Kind | None, prefixes: dict[str, str]) -> object:
    """A value as plain as its property lets it be."""
    if isinstance(value, NamedNode):
        compact = _compact(value.value, prefixes)
        return compact if kind else {"@id": compact}
    assert isinstance(value, Literal)
    if value.language:
        return {"@value": value.value, "@language": value.language}
    datatype = value.datatype.value
    plain = _plain(value.value, datatype)
    if kind or datatype in _NATIVE:
        return plain
    return {"@value": plain, "@type": _compact(datatype, prefixes)}


def _plain(text: str, datatype: str) -> object:
    if datatype == _XSD + "integer":
        return int(text)
    if datatype == _XSD + "double":
        return float(text)
    return text == "true" if datatype == _XSD + "boolean" else text


def _compact(iri: str, prefixes: dict[str, str]) -> str:
    """A prefixed name where there is a prefix for its namespace, else the IRI."""
    end = (iri.rfind("#") if "#" in iri else iri.rfind("/")) + 1
    prefix = prefixes.get(iri[:end])
    return f"{prefix}:{iri[end:]}" if prefix else iri
