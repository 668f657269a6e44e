"""RDF terms as plain Python values."""

from __future__ import annotations

from collections.abc import Mapping

from pyoxigraph import BlankNode, Literal, NamedNode

from afkb.store import QueryResult
from afkb.store.results import Cell, short_iri

Value = str | int | float | bool | None
_XSD = "http://www.w3.org/2001/XMLSchema#"
_WHOLE = frozenset(
    _XSD + name
    for name in ("integer", "int", "long", "short", "byte", "nonNegativeInteger", "positiveInteger")
)
_REAL = frozenset(_XSD + name for name in ("double", "float", "decimal"))


def rows_of(answer: QueryResult) -> list[dict[str, Value]]:
    """A row for each solution, variable to value; an ASK gives one row, `answer`."""
    if answer.truth is not None:
        return [{"answer": answer.truth}]
    prefixes = answer.prefixes or {}
    return [
        {name: value_of(cell, prefixes) for name, cell in zip(answer.columns, row, strict=True)}
        for row in answer.rows
    ]


def value_of(cell: Cell, prefixes: Mapping[str, str]) -> Value:
    """A number, truth value or text for a literal, a prefixed name (`afn:Mug`) for an IRI.

    None where a variable is unbound. Literals of other types come as their text.
    """
    if cell is None:
        return None
    if isinstance(cell, Literal):
        return _of_literal(cell)
    if isinstance(cell, NamedNode):
        return short_iri(cell.value, prefixes)
    return cell.value if isinstance(cell, BlankNode) else str(cell)


def _of_literal(cell: Literal) -> Value:
    datatype = cell.datatype.value
    if datatype in _WHOLE:
        return int(cell.value)
    if datatype in _REAL:
        return float(cell.value)
    if datatype == _XSD + "boolean":
        return cell.value in ("true", "1")
    return cell.value
