"""What an OWL file states, with the line of each subject and property where it is RDF/XML."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from urllib.parse import urljoin
from xml.parsers import expat

from pyoxigraph import Literal, NamedNode, RdfFormat

from afkb.extensions.statements import KEYED, Statements
from afkb.extensions.terms import WORD_OF
from afkb.ontology.names import AFN, RDF, RDF_TYPE
from afkb.ontology.rdf_files import RDF_FORMATS, read_triples

_XML_BASE = "http://www.w3.org/XML/1998/namespace base"


def owl_statements(path: Path) -> Statements:
    """The statements of an RDF/XML, Turtle or N-Triples file, those of blank nodes left out.

    `KnowledgeError`, with the line where it is known, for a file that can't be read.
    """
    statements = Statements(file=path.name)
    for triple in read_triples(path):
        subject, value = triple.subject, triple.object
        if isinstance(subject, NamedNode):
            text = value.value if isinstance(value, NamedNode | Literal) else str(value)
            statements.add(subject.value, triple.predicate.value, text)
        elif isinstance(value, NamedNode) and triple.predicate.value == RDF_TYPE:
            class_name = value.value.removeprefix(AFN)
            if class_name in WORD_OF or class_name in KEYED:
                statements.unnamed.append(class_name)
    form = RDF_FORMATS[path.suffix]
    if form is RdfFormat.RDF_XML:
        statements.places = _Lines(path).places()
    elif form is RdfFormat.TURTLE:
        statements.places = _turtle_places(path, statements)
    return statements


class _Lines:
    """Finds the lines of an RDF/XML file, as editors lay it out: subjects, and properties in them.

    The first description of a subject counts. Entities such as `&afn;` are resolved.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._places: dict[tuple[str, str], str] = {}
        self._bases = [path.resolve().as_uri()]
        self._subjects: list[str | None] = []
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end

    def places(self) -> dict[tuple[str, str], str]:
        """Subject and property to file and line."""
        # The file was read before: where lines can't be told, they are left out.
        with suppress(expat.ExpatError):
            self._parser.Parse(self._path.read_bytes(), True)
        return self._places

    def _start(self, tag: str, attributes: Mapping[str, str]) -> None:
        self._bases.append(attributes.get(_XML_BASE, self._bases[-1]))
        place = f"{self._path.name}, line {self._parser.CurrentLineNumber}"
        subject = self._subject(attributes)
        if subject is None and self._subjects and (outer := self._subjects[-1]):
            self._places.setdefault((outer, tag.replace(" ", "")), place)
        elif subject is not None:
            self._places.setdefault((subject, ""), place)
        self._subjects.append(subject)

    def _subject(self, attributes: Mapping[str, str]) -> str | None:
        about, name = attributes.get(f"{RDF} about"), attributes.get(f"{RDF} ID")
        if about is not None:
            return urljoin(self._bases[-1], about) if "://" not in about else about
        return f"{self._bases[-1].split('#')[0]}#{name}" if name is not None else None

    def _end(self, tag: str) -> None:
        self._bases.pop()
        self._subjects.pop()


def _turtle_places(path: Path, statements: Statements) -> dict[tuple[str, str], str]:
    """The first line that starts with a subject, by its IRI or the end of it."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    starts = {line.split()[0]: n for n, line in reversed(list(enumerate(lines, 1))) if line.strip()}
    places = {}
    for subject in statements.values:
        name = subject.rsplit("#", 1)[-1].rsplit("/", 1)[-1]
        for start, line in starts.items():
            if start == f"<{subject}>" or start.endswith(f":{name}"):
                places[subject, ""] = f"{path.name}, line {line}"
                break
    return places
