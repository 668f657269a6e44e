"""The library of ready-made queries: `afkb query MAP @things-by-category category=Chair`."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from pyoxigraph import NamedNode, Store

from afkb.errors import QueryError
from afkb.store.vocabulary import AFN, escaped, local_name

FOLDER = Path(__file__).parent / "queries"
NAME = "afn:"
NODE = "scene:"
NUMBER = "number"
"""What a parameter stands for: a name of the ontology, a node of the (first) map, or a number."""

_PARAMETER = re.compile(
    r"VALUES \?(?P<name>\w+) \{ (?P<default>\S+) \}  # parameter, "
    r"(?P<kind>afn:|scene:|number):? (?P<about>.+)"
)
_NUMBER = re.compile(r"[+-]?\d+(\.\d+)?")


@dataclass(frozen=True, slots=True)
class Parameter:
    """What may be given to a query: `kind` is `afn:`, `scene:` or `number`.

    In the query it is the line `VALUES ?name { default }  # parameter, kind: about`, so that the
    file is SPARQL as it stands.
    """

    name: str
    kind: str
    default: str
    about: str

    def term(self, value: str) -> str:
        """A value as SPARQL has it; `QueryError` for what can't be one."""
        if self.kind == NUMBER:
            if not _NUMBER.fullmatch(value):
                raise QueryError(
                    f"{self.name}={value!r}: a number is wanted, such as {self.name}=0.5"
                )
            return value
        name = value.removeprefix(self.kind)
        if not name or name.strip() != name:
            raise QueryError(f"{self.name}={value!r}: a name is wanted; {self.about}")
        return f"{self.kind}{_local(name)}"


@dataclass(frozen=True, slots=True)
class NamedQuery:
    """A query of the library: `name` without the @, what it answers, and its text."""

    name: str
    about: str
    sparql: str

    @property
    def parameters(self) -> list[Parameter]:
        """What can be given to it, in the order of its text."""
        return [
            Parameter(m["name"], m["kind"], m["default"].removeprefix(m["kind"]), m["about"])
            for m in _PARAMETER.finditer(self.sparql)
        ]

    def as_json(self) -> dict[str, object]:
        """As `afkb query --list --json` shows it: name, about, sparql, parameters."""
        return {
            "name": self.name,
            "about": self.about,
            "sparql": self.sparql,
            "parameters": [asdict(parameter) for parameter in self.parameters],
        }

    def filled(self, values: Mapping[str, str]) -> str:
        """The query with these values in place of the defaults; `QueryError` for an unknown one."""
        known = {parameter.name: parameter for parameter in self.parameters}
        text = self.sparql
        for name, value in values.items():
            if name not in known:
                takes = ", ".join(f"{p.name}={p.default}" for p in known.values()) or "none"
                raise QueryError(f"@{self.name} has no parameter {name!r}; it takes: {takes}")
            line = re.compile(rf"VALUES \?{re.escape(name)} \{{ \S+ \}}(?=  # parameter, )")
            term = known[name].term(value)
            text = line.sub(lambda _, n=name, t=term: f"VALUES ?{n} {{ {t} }}", text)  # type: ignore[misc]
        return text


def named_queries() -> list[NamedQuery]:
    """Every query of the library, by name; its first comment line says what it answers."""
    return [_read(path) for path in sorted(FOLDER.glob("*.rq"))]


def named_query(name: str) -> NamedQuery:
    """The query of that name, with or without its @; `QueryError` if there is none."""
    path = FOLDER / f"{name.removeprefix('@')}.rq"
    if path.parent != FOLDER or not path.is_file():
        known = [query.name for query in named_queries()]
        near = difflib.get_close_matches(name.removeprefix("@"), known, 3) or known
        there = ", ".join(f"@{one}" for one in near)
        raise QueryError(f"no named query {name!r}; there are: {there} (--list tells all)")
    return _read(path)


def read_values(words: Sequence[str]) -> dict[str, str]:
    """`NAME=VALUE` words as a mapping; `QueryError` for a word that is none.

    >>> read_values(["category=Mug", "below=0.5"])
    {'category': 'Mug', 'below': '0.5'}
    """
    values: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name or not value:
            raise QueryError(f"{word!r}: a parameter is given as NAME=VALUE, such as category=Mug")
        values[name] = value
    return values


def check_known(
    store: Store, query: NamedQuery, values: Mapping[str, str], scene: str | None
) -> None:
    """`QueryError` where a value is a name that neither ontology nor map has, with names near it.

    `scene`: the namespace of the first map's nodes.
    """
    bases = {NAME: AFN, NODE: scene}
    for parameter in query.parameters:
        base = bases.get(parameter.kind)
        if base is None or parameter.name not in values:
            continue
        name = values[parameter.name].removeprefix(parameter.kind)
        there = store.quads_for_pattern(NamedNode(base + escaped(name)), None, None)
        if next(there, None) is None:
            near = difflib.get_close_matches(name, _names(store, base), 3, cutoff=0.5)
            hint = f"; near it: {', '.join(near)}" if near else ""
            raise QueryError(f"{parameter.name}={name}: nothing is called that{hint}")


def unknown_names(store: Store, sparql: str) -> list[tuple[str, list[str]]]:
    """Names `afn:…` of a query that no statement has, each with those that are near it."""
    asked = dict.fromkeys(re.findall(r"(?<![\w:])afn:(\w+)", sparql))
    unknown = [name for name in asked if not _is_used(store, NamedNode(AFN + name))]
    known = _names(store, AFN) if unknown else []
    return [
        (f"afn:{name}", [f"afn:{n}" for n in difflib.get_close_matches(name, known, 3)])
        for name in unknown
    ]


def _is_used(store: Store, term: NamedNode) -> bool:
    patterns = ((term, None, None), (None, term, None), (None, None, term))
    return any(next(store.quads_for_pattern(*p), None) is not None for p in patterns)


def _names(store: Store, base: str) -> list[str]:
    subjects = {q.subject.value for q in store if isinstance(q.subject, NamedNode)}
    return sorted(local_name(iri) for iri in subjects if iri.startswith(base))


def _local(name: str) -> str:
    """A name as the local part of a prefixed name: what has a meaning there is escaped."""
    return re.sub(r"(^-|[~.!$&'()*+,;=/?#@])", r"\\\1", escaped(name))


def _read(path: Path) -> NamedQuery:
    text = path.read_text(encoding="utf-8")
    return NamedQuery(path.stem, text.splitlines()[0].lstrip("# "), text)
