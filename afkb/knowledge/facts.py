"""The statements of an ontology and its extensions, read once."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pyoxigraph import BlankNode, NamedNode, Triple

from afkb.errors import KnowledgeError
from afkb.ontology.names import AFN, ONTOLOGY_IRI, OWL, RDF_TYPE, fragment, property_iri
from afkb.ontology.rdf_files import RDF_FORMATS, read_triples

_Statement = tuple[str, str, str, bool]
"""Subject, property, value, and whether it is a text in another language than English."""


@dataclass(slots=True)
class Facts:
    """Subject to property to values, with the file in which each subject is first met.

    IRIs and literals are plain strings; blank nodes' statements are left out. Texts in other
    languages than English count where there is none in English. `again`: the file that states
    another value of a subject's property.
    """

    values: dict[str, dict[str, list[str]]] = field(default_factory=dict)
    file_of: dict[str, Path] = field(default_factory=dict)
    again: dict[tuple[str, str], Path] = field(default_factory=dict)
    in_other_languages: dict[tuple[str, str], str] = field(default_factory=dict)

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
            raise self.error(
                subject,
                f"{fragment(prop)} is stated {len(found)} times: {values}",
                self.again.get((subject, property_iri(prop))),
            )
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

    def error(self, subject: str, problem: str, file: Path | None = None) -> KnowledgeError:
        """The error to raise about a subject, with its file and line."""
        place = self.place(subject, file)
        return KnowledgeError(f"{place}: {fragment(subject)}: {problem}; mend it there")

    def place(self, subject: str, file: Path | None = None) -> str:
        """File and line where a subject is stated, as far as they can be told."""
        file = file or self.file_of.get(subject)
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
    for (subject, predicate), text in facts.in_other_languages.items():
        facts.values.setdefault(subject, {}).setdefault(predicate, [text])
    _check_imports(facts)
    return facts


def _extensions(files: Sequence[Path]) -> dict[Path, list[_Statement]]:
    """The statements of extensions in YAML or tables; all extensions are checked on the way."""
    if len(files) < 2:
        return {}
    from rdflib import URIRef

    from afkb.extensions import read_stack

    return {
        path: [(str(s), str(p), str(o), False) for s, p, o in graph if isinstance(s, URIRef)]
        for path, graph in read_stack(files).items()
    }


def _statements(file: Path) -> Iterable[_Statement]:
    return [_plain(t) for t in read_triples(file) if not isinstance(t.subject, BlankNode)]


def _plain(triple: Triple) -> _Statement:
    subject, value = triple.subject, triple.object
    assert isinstance(subject, NamedNode)
    text = f"_:{value.value}" if isinstance(value, BlankNode) else getattr(value, "value", "")
    foreign = getattr(value, "language", None) not in (None, "en")
    return subject.value, triple.predicate.value, text, foreign


def _collect(statements: Iterable[_Statement], file: Path, facts: Facts) -> None:
    says_something = False
    for subject, predicate, value, foreign in statements:
        if foreign:
            facts.in_other_languages.setdefault((subject, predicate), value)
            says_something = True
            continue
        properties = facts.values.setdefault(subject, {})
        values = properties.setdefault(predicate, [])
        if value not in values:
            values.append(value)
            if facts.file_of.get(subject, file) != file:
                facts.again[subject, predicate] = file
        facts.file_of.setdefault(subject, file)
        says_something = says_something or predicate != RDF_TYPE
    if not says_something:
        raise KnowledgeError(f"{file}: states nothing; start one with `afkb ontology new`")


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
    name = fragment(subject)
    about = re.compile(rf'(?:about|ID)="(?:[^"]*[#/;])?{re.escape(name)}"')
    marks = (f'"{subject}"', f'#{name}"', f"<{subject}>", f":{name} ")
    try:
        lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return None
    numbered = list(enumerate(lines, start=1))
    named = (n for n, line in numbered if any(mark in line for mark in marks))
    return next((n for n, line in numbered if about.search(line)), next(named, None))
