"""What can be said of a query's text: that it would write, or call out, or where it goes wrong."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from pyoxigraph import Store

from afkb.errors import QueryError
from afkb.store.vocabulary import PREFIXES, SCENES

_UPDATES = frozenset(
    ("INSERT", "DELETE", "LOAD", "CLEAR", "DROP", "CREATE", "ADD", "MOVE", "COPY", "WITH")
)
_QUERIES = frozenset(("SELECT", "ASK", "CONSTRUCT", "DESCRIBE"))

# Everything in which a word is not a keyword comes first: comments, IRIs, strings, names.
_TOKEN = re.compile(
    r"""
      \#[^\n]*
    | <[^<>"{}|^`\\\s]*>
    | \"{3}(?:(?!\"{3})(?:\\.|[^\\]))*\"{3} | '{3}(?:(?!'{3})(?:\\.|[^\\]))*'{3}
    | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*'
    | [?$]\w+ | @[A-Za-z]+(?:-[A-Za-z0-9]+)*
    | (?P<name>[\w.-]*:(?:[\w.:%-]|\\[-_~.!$&'()*+,;=/?\#@%])*)
    | (?P<word>[A-Za-z]\w*)
    """,
    re.VERBOSE | re.DOTALL,
)
_SERVICE = re.compile("service", re.IGNORECASE)
_POSITION = re.compile(r"error at (\d+):(\d+)")
_READ_TWICE_BELOW = 4000
"""Characters: of a longer query rdflib's parser would take seconds to find the fault."""


def _keywords(sparql: str) -> Iterator[tuple[str, int]]:
    for match in _TOKEN.finditer(sparql):
        if match["word"]:
            yield match["word"].upper(), match.start()


def refuse_writing(sparql: str) -> None:
    """`QueryError` for a SPARQL update, and for SERVICE, which would ask the network."""
    refuse_updates(sparql)
    for word, start in _keywords(sparql):
        if word == "SERVICE":
            raise _service_refused(sparql, start)
    _refuse_hidden_service(sparql)


def refuse_updates(sparql: str) -> None:
    """`QueryError` for a SPARQL update."""
    for word, start in _keywords(sparql):
        if word in _UPDATES and not _query_began(sparql, start):
            raise QueryError(
                f"{_place(sparql, start)}: {word} is a SPARQL update and a map is read-only; "
                "ask with SELECT, ASK, CONSTRUCT or DESCRIBE"
            )


def check_syntax(sparql: str, prefixes: Mapping[str, str]) -> None:
    """`QueryError`, with line and column, for a query that can't be parsed; nothing is asked.

    One with the word SERVICE is let through, since it would be run to be parsed.
    """
    if _SERVICE.search(sparql):
        return
    try:
        Store().query(sparql, prefixes=dict(prefixes))
    except SyntaxError as error:
        raise syntax_error(sparql, error) from error
    except (OSError, ValueError, RuntimeError):
        return


def _service_refused(sparql: str, start: int) -> QueryError:
    return QueryError(
        f"{_place(sparql, start)}: SERVICE would ask another server, which afkb doesn't; "
        "query several maps with --map A --map B, or that server with --endpoint URL"
    )


def _refuse_hidden_service(sparql: str) -> None:
    """`QueryError` where the word is a keyword after all, glued to a name or behind a `<`.

    `SERVICE:x` can be a name or a call, `?a<?b)SERVICE#>` an IRI or a comparison: only the engine's
    own parser knows. So it is asked, and never about the query itself, which would be run: one that
    still parses when the word is another everywhere has it in names and texts alone.
    """
    if not _SERVICE.search(sparql):
        return
    try:
        Store().query(_SERVICE.sub("servicx", sparql), prefixes=PREFIXES | {"scene": SCENES})
    except SyntaxError as error:
        raise syntax_error(sparql, error) from error
    except (OSError, ValueError, RuntimeError):
        return


def _query_began(sparql: str, before: int) -> bool:
    return any(word in _QUERIES and start < before for word, start in _keywords(sparql))


def syntax_error(sparql: str, error: SyntaxError) -> QueryError:
    """One line that says where a query can't be parsed and what stands there."""
    message = str(error)
    found = _POSITION.search(message)
    if found is None:
        return QueryError(f"SPARQL syntax error: {' '.join(message.split())}")
    line, column = int(found[1]), int(found[2])
    if "Prefix not found" in message and (name := _last_name(sparql, line, column)):
        prefix, column = name.partition(":")[0] + ":", column - len(name)
        return QueryError(
            f"SPARQL syntax error at line {line}, column {column}: the prefix {prefix!r} is not "
            "declared; add a PREFIX line or use afn:, geo:, prov:, skos:, rdfs: …"
        )
    line, column, rest = _second_opinion(sparql) or (line, column, _rest(sparql, line, column))
    near = f"near {_shortened(rest)!r}" if rest else "at the end of the query"
    return QueryError(
        f"SPARQL syntax error at line {line}, column {column}, {near}; "
        "see docs/sparql-cookbook.md for queries that work"
    )


def _second_opinion(sparql: str) -> tuple[int, int, str] | None:
    """Line, column and rest of line by rdflib's parser, which places errors more closely.

    Oxigraph reports how far it looked ahead, often the end; None where rdflib finds no fault, and
    for a query that is too long for it.
    """
    if len(sparql) > _READ_TWICE_BELOW:
        return None
    from pyparsing import ParseBaseException
    from rdflib.plugins.sparql.parser import parseQuery

    try:
        parseQuery(sparql)
    except ParseBaseException as error:
        return error.lineno, error.column, error.line[error.column - 1 :].strip()
    return None


def query_form(sparql: str) -> str:
    """SELECT, ASK, CONSTRUCT or DESCRIBE; empty where the text is no query.

    >>> query_form("PREFIX select: <urn:x#> ASK { ?s ?p 'DESCRIBE' }")
    'ASK'
    """
    return next((word for word, _ in _keywords(sparql) if word in _QUERIES), "")


def names_its_dataset(sparql: str) -> bool:
    """Whether the query itself says, with FROM or FROM NAMED, which graphs it is about."""
    return any(word == "FROM" for word, _ in _keywords(sparql))


def graphs_named(sparql: str) -> list[str]:
    """IRIs after FROM and FROM NAMED, where they are written out; prefixed names are left out.

    >>> graphs_named("SELECT * FROM <urn:a> FROM NAMED <urn:b> { ?s ?p ?o }")
    ['urn:a', 'urn:b']
    """
    found = []
    asked = False
    for match in _TOKEN.finditer(sparql):
        word = (match["word"] or "").upper()
        if word == "FROM" or (asked and (word == "NAMED" or match[0].startswith("#"))):
            asked = True
            continue
        if asked and match[0].startswith("<"):
            found.append(match[0][1:-1])
        asked = False
    return found


def _place(sparql: str, start: int) -> str:
    line = sparql.count("\n", 0, start) + 1
    return f"line {line}, column {start - (sparql.rfind(chr(10), 0, start) + 1) + 1}"


def _line(sparql: str, line: int) -> str:
    lines = sparql.split("\n")
    return lines[line - 1] if line <= len(lines) else ""


def _rest(sparql: str, line: int, column: int) -> str:
    return _line(sparql, line)[column - 1 :].strip()


def _shortened(text: str, length: int = 24) -> str:
    return text if len(text) <= length else text[:length] + "…"


def _last_name(sparql: str, line: int, column: int) -> str:
    found = re.search(r"(?<![\w?$])[\w.-]*:[\w.%-]*$", _line(sparql, line)[: column - 1])
    return found[0] if found else ""
