"""Answers to queries, and how they are written: table rows, CSV, TSV, SPARQL JSON, XML, RDF."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from pyoxigraph import (
    BlankNode,
    Literal,
    NamedNode,
    QueryBoolean,
    QueryResultsFormat,
    QuerySolutions,
    QueryTriples,
    RdfFormat,
    Triple,
    parse_query_results,
    serialize,
)

from afkb.errors import QueryError
from afkb.store.turtle import canonical

Cell = NamedNode | BlankNode | Literal | Triple | None
FORMATS = ("table", "csv", "tsv", "json", "xml", "ttl", "nt")
_ROWS = {
    "csv": QueryResultsFormat.CSV,
    "tsv": QueryResultsFormat.TSV,
    "xml": QueryResultsFormat.XML,
}
_TRIPLES = {
    "json": RdfFormat.JSON_LD,
    "xml": RdfFormat.RDF_XML,
    "ttl": RdfFormat.TURTLE,
    "nt": RdfFormat.N_TRIPLES,
}


@dataclass(frozen=True)
class QueryResult:
    """What a query gave: rows (SELECT), a truth value (ASK) or triples (CONSTRUCT, DESCRIBE).

    - `columns`: variable names; for triples `subject`, `predicate`, `object`; for ASK `answer`.
    - `rows`: RDF terms, None where a variable is unbound.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    truth: bool | None = None
    triples: tuple[Triple, ...] | None = None
    prefixes: Mapping[str, str] | None = None

    @classmethod
    def read(
        cls, answer: QuerySolutions | QueryBoolean | QueryTriples, prefixes: Mapping[str, str]
    ) -> QueryResult:
        """Read an answer to its end."""
        if isinstance(answer, QueryBoolean):
            return cls(("answer",), (), truth=bool(answer), prefixes=prefixes)
        if isinstance(answer, QueryTriples):
            return cls.of_triples(answer, prefixes)
        columns = tuple(variable.value for variable in answer.variables)
        rows = tuple(tuple(solution[c] for c in columns) for solution in answer)
        return cls(columns, rows, prefixes=prefixes)

    @classmethod
    def of_triples(cls, found: Iterable[Triple], prefixes: Mapping[str, str]) -> QueryResult:
        """What CONSTRUCT and DESCRIBE gave, without doubles, in a fixed order."""
        triples = tuple(canonical(found))
        rows = tuple((t.subject, t.predicate, t.object) for t in triples)
        return cls(("subject", "predicate", "object"), rows, triples=triples, prefixes=prefixes)

    def cells(self) -> list[tuple[str, ...]]:
        """Rows as short text: prefixed names, plain numbers."""
        if self.truth is not None:
            return [("true" if self.truth else "false",)]
        return [tuple(self._short(cell) for cell in row) for row in self.rows]

    def _short(self, cell: Cell) -> str:
        if cell is None:
            return ""
        if isinstance(cell, NamedNode):
            return short_iri(cell.value, self.prefixes or {})
        return cell.value if isinstance(cell, Literal | BlankNode) else str(cell)

    def text(self, form: str) -> str:
        """The answer as `csv`, `tsv`, `json`, `xml`, `ttl` or `nt`; triples as rows, too.

        `QueryError` where the two don't go together: Turtle and N-Triples need triples.
        """
        if self.triples is not None and form in _TRIPLES:
            return self._rdf(_TRIPLES[form])
        if form == "json":
            return self._json()
        if form not in _ROWS:
            raise QueryError(
                "Turtle needs triples: write a CONSTRUCT or DESCRIBE, or choose --format table, "
                "csv or json"
            )
        if self.truth is not None and form != "xml":
            # The standard has no CSV for ASK.
            return f"answer\n{'true' if self.truth else 'false'}\n"
        # Oxigraph writes what it has read: the standard's escapes are its business.
        answer = parse_query_results(self._json(), format=QueryResultsFormat.JSON)
        return (answer.serialize(format=_ROWS[form]) or b"").decode()

    def _json(self) -> str:
        if self.truth is not None:
            return json.dumps({"head": {}, "boolean": self.truth}) + "\n"
        bindings = [
            {c: _binding(cell) for c, cell in zip(self.columns, row, strict=True) if cell}
            for row in self.rows
        ]
        shape = {"head": {"vars": list(self.columns)}, "results": {"bindings": bindings}}
        return json.dumps(shape, indent=1, ensure_ascii=False) + "\n"

    def _rdf(self, form: RdfFormat) -> str:
        prefixes = dict(self.prefixes or {}) if form == RdfFormat.TURTLE else None
        written = serialize(self.triples or (), format=form, prefixes=prefixes)
        return (written or b"").decode()


def _binding(cell: Cell) -> dict[str, str]:
    """A term as SPARQL 1.1 Query Results JSON has it."""
    if isinstance(cell, NamedNode):
        return {"type": "uri", "value": cell.value}
    if isinstance(cell, BlankNode):
        return {"type": "bnode", "value": cell.value}
    if not isinstance(cell, Literal):
        raise QueryError(f"{cell}: a quoted triple can't be written as SPARQL JSON")
    binding = {"type": "literal", "value": cell.value}
    if cell.language:
        return binding | {"xml:lang": cell.language}
    if cell.datatype.value != "http://www.w3.org/2001/XMLSchema#string":
        return binding | {"datatype": cell.datatype.value}
    return binding


def short_iri(iri: str, prefixes: Mapping[str, str]) -> str:
    """An IRI as a prefixed name (`afn:Mug`), or as it is where no prefix fits."""
    for prefix, namespace in prefixes.items():
        if iri.startswith(namespace):
            return f"{prefix}:{iri[len(namespace) :]}"
    return iri
