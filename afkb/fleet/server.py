"""A SPARQL 1.1 server: asked and told patiently, through whatever URLs it has for that."""

from __future__ import annotations

import json
import random
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar
from urllib.parse import urlencode, urlsplit

from pyoxigraph import RdfFormat, Triple, parse

from afkb.errors import EndpointError
from afkb.store.http import Address, PassingTrouble, Refusal, Reply, post

PATIENCE_S = 60.0
"""How long a server may be away before it is given up, s: long enough for one to start again."""
FIRST_WAIT_S = 0.25
LONGEST_WAIT_S = 10.0
_FORM = "application/x-www-form-urlencoded"
_ROWS = "application/sparql-results+json"
_TRIPLES = "application/n-triples, text/turtle;q=0.5"

T = TypeVar("T")


@dataclass(frozen=True)
class Server:
    """Where a SPARQL 1.1 server is asked (`query_at`) and told (`update_at`).

    Requests are repeated, ever later, while the server is away or busy, for `patience_s` in all;
    so each must do no harm when it is done twice. `tell` hears, in a line, that it is waited.
    """

    query_at: Address
    update_at: Address
    patience_s: float = PATIENCE_S
    timeout_s: float = 60.0
    tell: Callable[[str], None] = field(default=lambda _: None, repr=False)

    @classmethod
    def find(
        cls,
        url: str,
        update_url: str | None = None,
        patience_s: float = PATIENCE_S,
        tell: Callable[[str], None] = lambda _: None,
        to_write: bool = True,
    ) -> Server:
        """The server at a URL: its base (`http://localhost:7878`) or its query endpoint.

        What it takes queries and updates at is found by asking: `/query` and `/update` (Oxigraph,
        Fuseki), `/sparql`, `/statements` (RDF4J, GraphDB), or one URL for both. `update_url` names
        the latter where that finds nothing; it is not looked for unless something is `to_write`.
        `EndpointError` where no SPARQL is spoken.
        """
        address = Address.read(url)
        if address.shows_credentials:
            tell(f"note: {address.url}: credentials go there unencrypted; prefer https")
        apart = None if update_url is None else _of_updates(update_url, address)
        if apart is not None and apart.shows_credentials and not address.shows_credentials:
            tell(f"note: {apart.url}: credentials go there unencrypted; prefer https")
        base = address.url.removesuffix("/query").removesuffix("/sparql")
        asked = dict.fromkeys([address.url, f"{base}/query", f"{base}/sparql"])
        told = dict.fromkeys([f"{base}/update", f"{base}/statements", address.url])
        first = cls(address, address, patience_s, tell=tell)
        query_at = first._first_that_works(list(asked), _answers, "answers no SPARQL query")
        if not to_write:
            return cls(query_at, query_at, patience_s, tell=tell)
        what = "takes no SPARQL update; name where it does, or one that does (--update-url)"
        asking = first if apart is None else cls(apart, apart, patience_s, tell=tell)
        updates = list(told) if apart is None else [apart.url]
        update_at = asking._first_that_works(updates, _takes_updates, what)
        return cls(query_at, update_at, patience_s, tell=tell)

    def _first_that_works(
        self, urls: list[str], works: Callable[[Address, float], bool], what: str
    ) -> Address:
        refusals: list[str] = []
        for url in urls:
            address = self.query_at.at(url)
            try:
                if self._patiently(lambda at=address: works(at, self.timeout_s)):  # type: ignore[misc]
                    return address
            except Refusal as error:
                if error.status == 401:
                    raise
                refusals.append(str(error))
        why = f" ({refusals[-1]})" if refusals else ""
        raise EndpointError(f"{self.query_at.url}: {what}{why}")

    def ask(self, sparql: str) -> list[dict[str, str]]:
        """The rows of a SELECT, each variable's value as text; unbound ones are left out."""
        reply = self._patiently(lambda: _query(self.query_at, sparql, _ROWS, self.timeout_s))
        try:
            rows = json.loads(reply.body)["results"]["bindings"]
            return [{name: str(cell["value"]) for name, cell in row.items()} for row in rows]
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise EndpointError(f"{self.query_at.url}: its answer is no SPARQL result") from error

    def count(self, graph: str) -> int:
        """How many statements a graph holds; 0 where there is none of that name."""
        rows = self.ask(f"SELECT (COUNT(*) AS ?n) WHERE {{ GRAPH <{graph}> {{ ?s ?p ?o }} }}")
        return int(rows[0]["n"]) if rows else 0

    def triples(self, graph: str) -> list[Triple]:
        """All statements of a graph."""
        sparql = f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ GRAPH <{graph}> {{ ?s ?p ?o }} }}"
        reply = self._patiently(lambda: _query(self.query_at, sparql, _TRIPLES, self.timeout_s))
        form = RdfFormat.from_media_type(reply.media_type)
        try:
            found = parse(reply.body, format=form or RdfFormat.N_TRIPLES)
            return [quad.triple for quad in found]
        except (SyntaxError, ValueError) as error:
            raise EndpointError(
                f"{self.query_at.url}: its answer is no RDF ({reply.media_type})"
            ) from error

    def update(self, sparql: str) -> None:
        """Have an update done; done twice where the answer to the first one is lost."""
        self._patiently(lambda: _update(self.update_at, sparql, self.timeout_s))

    def _patiently(self, action: Callable[[], T]) -> T:
        """What the action returns, tried again while trouble may pass and patience lasts."""
        until = time.monotonic() + self.patience_s
        wait = FIRST_WAIT_S
        while True:
            try:
                return action()
            except PassingTrouble as error:
                # Many robots that lost the same server shall not come back in the same moment.
                pause = max(error.wait_s or 0.0, wait * random.uniform(0.5, 1.0))
                if time.monotonic() + pause > until:
                    if not self.patience_s:
                        raise
                    raise EndpointError(f"{error}; given up after {self.patience_s:g} s") from error
                if wait >= 1:
                    self.tell(f"{error}; trying again in {pause:.1f} s")
                time.sleep(pause)
                wait = min(2 * wait, LONGEST_WAIT_S)


def _of_updates(url: str, asked: Address) -> Address:
    """Where updates go: with credentials of its own, or those of the other URL on the same host."""
    given = Address.read(url)
    same = urlsplit(given.url).hostname == urlsplit(asked.url).hostname
    return asked.at(given.url) if same and urlsplit(url).username is None else given


def _query(address: Address, sparql: str, accept: str, timeout_s: float) -> Reply:
    body = urlencode({"query": sparql}).encode()
    return post(address, body, _FORM, accept, timeout_s)


def _update(address: Address, sparql: str, timeout_s: float) -> Reply:
    return post(address, sparql.encode(), "application/sparql-update", timeout_s=timeout_s)


def _answers(address: Address, timeout_s: float) -> bool:
    reply = _query(address, "ASK {}", _ROWS, timeout_s)
    try:
        return json.loads(reply.body)["boolean"] is True
    except (ValueError, KeyError, TypeError):
        return False


def _takes_updates(address: Address, timeout_s: float) -> bool:
    _update(address, "INSERT DATA {}", timeout_s)
    return True
