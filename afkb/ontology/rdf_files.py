"""Reads files of RDF; a message about a broken one says the line, where it can be told."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.parsers import expat

from pyoxigraph import RdfFormat, Triple, parse

from afkb.errors import KnowledgeError

RDF_FORMATS = {
    ".owl": RdfFormat.RDF_XML,
    ".rdf": RdfFormat.RDF_XML,
    ".xml": RdfFormat.RDF_XML,
    ".ttl": RdfFormat.TURTLE,
    ".turtle": RdfFormat.TURTLE,
    ".nt": RdfFormat.N_TRIPLES,
}
"""RDF by the end of the file's name; anything else is an extension in YAML or tables."""


def read_triples(path: Path) -> Iterator[Triple]:
    """What a file states, triple by triple; `KnowledgeError` where it can't be read."""
    try:
        yield from parse(path=str(path), format=RDF_FORMATS[path.suffix])
    except (SyntaxError, ValueError, OSError) as error:
        raise unreadable(path, error) from error


def unreadable(path: Path, error: Exception) -> KnowledgeError:
    """The error to raise about a file that a parser gave up on, with the line and the mend."""
    form = RDF_FORMATS[path.suffix]
    line = getattr(error, "lineno", None)
    if line is None and form is RdfFormat.RDF_XML:
        line = _broken_line(path)
    where = f", line {line}" if line else ""
    said = " ".join(str(error.args[0] if error.args else "unreadable").split())
    return KnowledgeError(
        f"{path}{where}: not readable as {form.name}: {said}; save it as RDF/XML or Turtle"
    )


def _broken_line(path: Path) -> int | None:
    """The line at which a file stops being XML, or None where it is XML."""
    try:
        expat.ParserCreate().Parse(path.read_bytes(), True)
    except expat.ExpatError as error:
        return error.lineno
    except OSError:
        return None
    return None
