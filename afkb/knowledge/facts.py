"""The statements of an ontology and its extensions, read once through owlready2."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from afkb.errors import KnowledgeError
from afkb.ontology.names import AFN, RDF_TYPE


@dataclass(slots=True)
class Facts:
    """Subject to property to values, with the file in which each subject is first met.

    IRIs are plain strings; literals are told from them by `literals`.
    """

    values: dict[str, dict[str, list[str]]] = field(default_factory=dict)
    file_of: dict[str, Path] = field(default_factory=dict)

    def of_type(self, class_name: str) -> list[str]:
        """IRIs of the individuals of one of the ontology's classes, by name."""
        wanted = AFN + class_name
        return sorted(s for s, p in self.values.items() if wanted in p.get(RDF_TYPE, ()))

    def many(self, subject: str, prop: str) -> list[str]:
        """All values, sorted."""
        return sorted(self.values.get(subject, {}).get(_full(prop), []))

    def one(self, subject: str, prop: str) -> str | None:
        """The value, or None; `KnowledgeError` where two files state different ones."""
        found = self.many(subject, prop)
        if len(found) > 1:
            raise self.error(subject, f"{prop} is stated {len(found)} times: {', '.join(found)}")
        return found[0] if found else None

    def text(self, subject: str, prop: str, default: str | None = None) -> str:
        """The value; `KnowledgeError` where there is none and no default."""
        value = self.one(subject, prop)
        if value is None and default is None:
            raise self.error(subject, f"{prop} is missing")
        return value if value is not None else str(default)

    def number(self, subject: str, prop: str, default: float | None = None) -> float:
        """The value as a finite number."""
        value = self.one(subject, prop)
        if value is None:
            if default is None:
                raise self.error(subject, f"{prop} is missing")
            return default
        try:
            number = float(value)
        except ValueError:
            raise self.error(subject, f"{prop} {value!r} is no number") from None
        if not math.isfinite(number):
            raise self.error(subject, f"{prop} {value!r} is not finite")
        return number

    def probability(self, subject: str, prop: str) -> float:
        """The value as a probability."""
        number = self.number(subject, prop)
        if not 0 <= number <= 1:
            raise self.error(subject, f"{prop} {number} is not in 0..1")
        return number

    def error(self, subject: str, problem: str) -> KnowledgeError:
        """The error to raise about a subject, with its file."""
        file = self.file_of.get(subject, Path("?"))
        return KnowledgeError(f"{file}: {subject.removeprefix(AFN)}: {problem}; mend it there")


def read_facts(files: Sequence[Path]) -> Facts:
    """Load RDF/XML files, in order, into a world of their own and return what they state.

    Raises `KnowledgeError`, naming the file, where one is missing, can't be parsed, or imports
    an ontology that isn't among them.
    """
    import owlready2

    world = owlready2.World()
    facts = Facts()
    try:
        for file in files:
            _collect(world, _load(world, file), file, facts)
    finally:
        world.close()
    return facts


def _load(world: Any, file: Path) -> Any:
    if not file.is_file():
        raise KnowledgeError(f"{file}: no such ontology file")
    try:
        return world.get_ontology(file.resolve().as_uri()).load(only_local=True)
    except Exception as error:  # owlready2 lets its parser's and its SQL layer's errors through
        first = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
        raise KnowledgeError(
            f"{file}: not readable as RDF/XML: {first}; "
            "save it as RDF/XML, and leave out imports of ontologies that are not beside it"
        ) from error


def _collect(world: Any, ontology: Any, file: Path, facts: Facts) -> None:
    graph = world.as_rdflib_graph().get_context(ontology)
    if all(str(predicate) == RDF_TYPE for _, predicate, _ in graph.triples((None, None, None))):
        raise KnowledgeError(f"{file}: states nothing; expected an ontology in RDF/XML")
    for subject, predicate, value in graph.triples((None, None, None)):
        properties = facts.values.setdefault(str(subject), {})
        values = properties.setdefault(str(predicate), [])
        if str(value) not in values:
            values.append(str(value))
        facts.file_of.setdefault(str(subject), file)


def _full(prop: str) -> str:
    return prop if ":" in prop else AFN + prop
