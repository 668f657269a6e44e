"""Answers to queries, and how they are written: table rows, CSV, SPARQL JSON, Turtle."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass

from pyoxigraph import (
    BlankNode,
    Literal,
    NamedNode,
    QueryBoolean,
    QuerySolutions,
    QueryTriples,
    RdfFormat,
    Triple,
    serialize,
)

from afkb.errors import QueryError
from afkb.store.turtle import canonical

Cell = NamedNode | BlankNode | Literal | Triple | None
FORMATS = ("table", "csv", "json", "ttl")


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
            triples = tuple(canonical(answer))
            rows = tuple((t.subject, t.predicate, t.object) for t in triples)
            return cls(("subject", "predicate", "object"), rows, triples=triples, prefixes=prefixes)
        columns = tuple(variable.value for variable in answer.variables)
        rows = tuple(tuple(solution[c] for c in columns) for solution in answer)
        return cls(columns, rows, prefixes=prefixes)

    def cells(self) -> list[tuple[str, ...]]:
        """Rows as short text: prefixed names, plain numbers."""
        if self.truth is not None:
            return [("true" if self.truth else "false",)]
        return [tuple(self._short(cell) for cell in row) for row in self.rows]

    def _short(self, cell: Cell) -> str:
        if cell is None:
            return ""
        if isinstance(cell, NamedNode):
            for prefix, iri in (self.prefixes or {}).items():
                if cell.value.startswith(iri):
                    return f"{prefix}:{cell.value[len(iri) :]}"
        return cell.value if isinstance(cell, NamedNode | Literal | BlankNode) else str(cell)

    def text(self, form: str) -> str:
        """The answer as `csv`, `json` or `ttl`; `QueryError` where the two don't go together."""
        if form == "csv":
            return self._csv()
        if form == "json":
            return self._json()
        if self.triples is None:
            raise QueryError(
                "Turtle needs triples: write a CONSTRUCT or DESCRIBE, or choose --format table, "
                "csv or json"
            )
        return self._rdf(RdfFormat.TURTLE)

    def _csv(self) -> str:
        import csv
        import io

        out = io.StringIO()
        writer = csv.writer(out)
        writer.writerow(self.columns)
        writer.writerows([_plain(cell) for cell in row] for row in self.rows)
        if self.truth is not None:
            writer.writerow(["true" if self.truth else "false"])
        return out.getvalue()

    def _json(self) -> str:
        if self.truth is not None:
            return json.dumps({"head": {}, "boolean": self.truth}) + "\n"
        if self.triples is not None:
            return self._rdf(RdfFormat.JSON_LD)
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


def _plain(cell: Cell) -> str:
    if cell is None:
        return ""
    return cell.value if isinstance(cell, NamedNode | Literal) else str(cell)


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
