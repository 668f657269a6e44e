"""SPARQL over a server's maps, by the SPARQL 1.1 Protocol."""

from __future__ import annotations

import re
from collections.abc import Sequence
from urllib.parse import urlencode

from pyoxigraph import NamedNode, QueryResultsFormat, RdfFormat, Triple, parse
from pyoxigraph import parse_query_results as parse_results

from afkb.errors import EndpointError
from afkb.store.http import Address, Reply, post
from afkb.store.results import QueryResult
from afkb.store.sparql_text import check_syntax, query_form, refuse_updates
from afkb.store.vocabulary import PREFIXES

RESULTS = {
    "application/sparql-results+json": QueryResultsFormat.JSON,
    "application/json": QueryResultsFormat.JSON,
    "application/sparql-results+xml": QueryResultsFormat.XML,
    "text/tab-separated-values": QueryResultsFormat.TSV,
}
"""Media types of what SELECT and ASK give, that lose nothing."""
GRAPHS = {
    "application/n-triples": RdfFormat.N_TRIPLES,
    "text/turtle": RdfFormat.TURTLE,
    "application/rdf+xml": RdfFormat.RDF_XML,
    "application/ld+json": RdfFormat.JSON_LD,
}
"""Media types of what CONSTRUCT and DESCRIBE give."""
WAIT_S = 60.0
"""How long a server may take unless the user says otherwise."""

_MAPS = """SELECT ?map WHERE {
  { ?map a afn:TopologicalMap } UNION { GRAPH ?g { ?map a afn:TopologicalMap } }
}"""


def query_endpoint(
    url: str,
    sparql: str,
    default_graphs: Sequence[str] = (),
    named_graphs: Sequence[str] = (),
    timeout_s: float = WAIT_S,
) -> QueryResult:
    """The answer of the server at `url` to a SELECT, ASK, CONSTRUCT or DESCRIBE.

    `default_graphs`, `named_graphs`: IRIs that stand in for FROM and FROM NAMED. The prefixes of
    `afkb query` are sent along; `scene:` is that of the server's one map, or of the first by name.
    `QueryError` for an update or a slip in the query, before anything is sent. `EndpointError`
    where nobody answers in time, the server refuses (with its own words, shortened), or what
    comes back is no SPARQL result. Credentials: see `Address.read`.
    """
    refuse_updates(sparql)
    address = Address.read(url)
    graphs = (default_graphs, named_graphs)
    prefixes = dict(PREFIXES)
    if re.search(r"(?<![\w.-])scene:", sparql):
        prefixes["scene"] = _scene(address, graphs, timeout_s)
    check_syntax(sparql, prefixes)
    reply = _ask(address, _declared(sparql, prefixes), graphs, timeout_s)
    return _read(address, reply, prefixes)


def _ask(
    address: Address, sparql: str, graphs: tuple[Sequence[str], Sequence[str]], timeout_s: float
) -> Reply:
    form = [("query", sparql)]
    form += [("default-graph-uri", name) for name in graphs[0]]
    form += [("named-graph-uri", name) for name in graphs[1]]
    wanted = RESULTS if query_form(sparql) in ("SELECT", "ASK") else GRAPHS
    accept = ", ".join(f"{media};q={1 - 0.1 * n:g}" for n, media in enumerate(wanted))
    body = urlencode(form).encode()
    return post(address, body, "application/x-www-form-urlencoded", accept, timeout_s)


def _scene(address: Address, graphs: tuple[Sequence[str], Sequence[str]], timeout_s: float) -> str:
    """The namespace of the nodes of the server's map."""
    reply = _ask(address, _declared(_MAPS, PREFIXES), graphs, timeout_s)
    maps = [row[0] for row in _read(address, reply, {}).rows]
    found = sorted(name.value for name in maps if isinstance(name, NamedNode))
    if not found:
        raise EndpointError(
            f"{address.url}: has no map there, so scene: stands for nothing; "
            "name the map's graph with --graph, or write full IRIs"
        )
    return found[0].rsplit("#", 1)[0] + "#"


def _declared(sparql: str, prefixes: dict[str, str]) -> str:
    """The query with the prefixes that it uses; on its first line, so that lines stay numbered."""
    used = [
        f"PREFIX {prefix}: <{iri}> "
        for prefix, iri in prefixes.items()
        if re.search(rf"(?<![\w.-]){prefix}:", sparql)
    ]
    return "".join(used) + sparql


def _read(address: Address, reply: Reply, prefixes: dict[str, str]) -> QueryResult:
    try:
        if reply.media_type in RESULTS:
            answer = parse_results(reply.body, format=RESULTS[reply.media_type])
            return QueryResult.read(answer, prefixes)
        if reply.media_type in GRAPHS:
            quads = parse(reply.body, format=GRAPHS[reply.media_type])
            triples = [Triple(q.subject, q.predicate, q.object) for q in quads]
            return QueryResult.of_triples(triples, prefixes)
    except (SyntaxError, ValueError, OSError) as error:
        short = " ".join(str(error).split())[:200]
        raise EndpointError(
            f"{address.url}: its answer can't be read as {reply.media_type}: {short}"
        ) from error
    raise EndpointError(
        f"{address.url}: answers with {reply.media_type or 'no media type'}, which is no SPARQL "
        "result; is that the URL for queries? (often it ends in /sparql or /query)"
    )
