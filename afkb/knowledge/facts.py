"""The statements of an ontology and its extensions, read once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pyoxigraph import BlankNode, NamedNode, Triple

from afkb.errors import KnowledgeError
from afkb.ontology.names import AFN, ONTOLOGY_IRI, OWL, RDF_TYPE, property_iri
from afkb.ontology.rdf_files import RDF_FORMATS, read_triples


@dataclass(slots=True)
class Facts:
    """Subject to property to values, with the file in which each subject is first met.

    IRIs and literals are plain strings; blank nodes' statements are left out.
    """

    values: dict[str, dict[str, list[str]]] = field(default_factory=dict)
    file_of: dict[str, Path] = field(default_factory=dict)

    def of_type(self, class_name: str) -> list[str]:
        """IRIs of the individuals of one of the ontology's classes, by name."""
        wanted = AFN + class_name
        return sorted(s for s, p in self.values.items() if wanted in p.get(RDF_TYPE, ()))

    def many(self, subject: str, prop: str) -> list[str]:
        """All values, sorted."""
        return sorted(self.values.get(subject, {}).get(property_iri(prop), []))

    def one(self, subject: str, prop: str) -> str | None:
        """The value, or None; `KnowledgeError` where two files state different ones."""
        found = self.values.get(subject, {}).get(property_iri(prop), [])
        if len(found) > 1:
            values = ", ".join(sorted(found))
            raise self.error(subject, f"{prop} is stated {len(found)} times: {values}")
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
        """The error to raise about a subject, with its file and line."""
        name = subject.removeprefix(AFN)
        return KnowledgeError(f"{self.place(subject)}: {name}: {problem}; mend it there")

    def place(self, subject: str) -> str:
        """File and line where a subject is stated, as far as they can be told."""
        file = self.file_of.get(subject)
        row = self.many(subject, "fromRow")
        if file is None:
            return row[0] if row else "?"
        if file.suffix not in RDF_FORMATS:
            return f"{file.parent / row[0]}" if row else str(file)
        line = _line_of(file, subject)
        return f"{file}, line {line}" if line else str(file)


def read_facts(files: Sequence[Path]) -> Facts:
    """What the files state, in order: RDF/XML, Turtle, and extensions in YAML or tables.

    Raises `KnowledgeError`, naming the file, where one is missing, can't be parsed, or imports
    an ontology that isn't among them.
    """
    missing = [file for file in files if not file.exists()]
    if missing:
        raise KnowledgeError(f"{missing[0]}: no such ontology file")
    facts = Facts()
    plain = _extensions(files)
    for file in files:
        if file in plain or file.suffix in RDF_FORMATS:
            _collect(plain.get(file) or _statements(file), file, facts)
    _check_imports(facts)
    return facts


def _extensions(files: Sequence[Path]) -> dict[Path, list[tuple[str, str, str]]]:
    """The statements of extensions in YAML or tables; all extensions are checked on the way."""
    if len(files) < 2:
        return {}
    from rdflib import URIRef

    from afkb.extensions import read_stack

    return {
        path: [(str(s), str(p), str(o)) for s, p, o in graph if isinstance(s, URIRef)]
        for path, graph in read_stack(files).items()
    }


def _statements(file: Path) -> Iterable[tuple[str, str, str]]:
    return [_plain(t) for t in read_triples(file) if not isinstance(t.subject, BlankNode)]


def _plain(triple: Triple) -> tuple[str, str, str]:
    subject, value = triple.subject, triple.object
    assert isinstance(subject, NamedNode)
    text = f"_:{value.value}" if isinstance(value, BlankNode) else getattr(value, "value", "")
    return subject.value, triple.predicate.value, text


def _collect(statements: Iterable[tuple[str, str, str]], file: Path, facts: Facts) -> None:
    says_something = False
    for subject, predicate, value in statements:
        properties = facts.values.setdefault(subject, {})
        values = properties.setdefault(predicate, [])
        if value not in values:
            values.append(value)
        facts.file_of.setdefault(subject, file)
        says_something = says_something or predicate != RDF_TYPE
    if not says_something:
        raise KnowledgeError(f"{file}: states nothing; expected an ontology or an extension of one")


def _check_imports(facts: Facts) -> None:
    read = set(facts.values) | {ONTOLOGY_IRI}
    for subject, properties in facts.values.items():
        for imported in properties.get(OWL + "imports", ()):
            if imported not in read and not imported.startswith(ONTOLOGY_IRI):
                raise KnowledgeError(
                    f"{facts.file_of[subject]}: imports {imported}, which is not among the files "
                    "given; give its file too, or leave the import out"
                )


def _line_of(file: Path, subject: str) -> int | None:
    """The line on which an OWL file speaks of a subject first, or None."""
    name = subject.rsplit("#", 1)[-1].rsplit("/", 1)[-1]
    marks = (f'"{subject}"', f'#{name}"', f"<{subject}>", f":{name} ")
    try:
        lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return None
    about = [n for n, line in enumerate(lines, start=1) if any(mark in line for mark in marks)]
    return about[0] if about else None
