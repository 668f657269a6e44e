"""Requests that are meant to do harm, each with the statuses that are a right answer to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from bench.serving.watched import QUERY

_PRODUCT = "?a ?p ?b . ?c ?q ?d . ?e ?r ?f . ?g ?s ?h"
_DOUBLED = " ".join(f"BIND(CONCAT(?x{n}, ?x{n}) AS ?x{n + 1})" for n in range(40))
_PATH = "(!afn:x|^!afn:x)*"
_EVIL = "(a|a)*" * 12 + "b$"
_NAMES = "?a ?p ?b . ?c ?q ?b"
_FORM = {"Content-Type": "application/x-www-form-urlencoded"}
_UPDATE = {"Content-Type": "application/sparql-update"}
STOPPED = (422, 504)
"""Refused for what it takes."""


@dataclass(frozen=True, slots=True)
class Bomb:
    """A request and the statuses that it may have."""

    name: str
    right: tuple[int, ...]
    body: bytes | None = None
    method: str = "POST"
    path: str = "/sparql"
    headers: Mapping[str, str] = field(default_factory=lambda: QUERY)


def asked(name: str, right: tuple[int, ...], sparql: str) -> Bomb:
    """A query that is posted."""
    return Bomb(name, right, sparql.encode())


def bombs(elsewhere: str) -> list[Bomb]:
    """All of them; `elsewhere`: host and port of a server that must not be asked."""
    return [*_heavy(), *_malformed(), *_reaching_out(elsewhere), *_writing(), *_paths()]


def _heavy() -> list[Bomb]:
    return [
        asked("product, counted", STOPPED, f"SELECT (COUNT(*) AS ?n) {{ {_PRODUCT} }}"),
        asked("product, all rows", STOPPED, f"SELECT * {{ {_PRODUCT} }}"),
        asked("product, sorted", STOPPED, f"SELECT * {{ {_PRODUCT} }} ORDER BY ?h ?f ?d"),
        asked("product, distinct", STOPPED, f"SELECT DISTINCT ?a ?d ?f {{ {_PRODUCT} }}"),
        asked("product, grouped", STOPPED,
              f"SELECT ?a (GROUP_CONCAT(?d) AS ?n) {{ {_PRODUCT} }} GROUP BY ?a"),
        Bomb("product, constructed", STOPPED,
             f"CONSTRUCT {{ ?a ?q ?h }} WHERE {{ {_PRODUCT} }}".encode(),
             headers={**QUERY, "Accept": "text/turtle"}),
        asked("strings doubled 40 times", STOPPED,
              f'SELECT * {{ BIND("0123456789" AS ?x0) {_DOUBLED} }}'),
        asked("paths through everything", STOPPED,
              f"SELECT (COUNT(*) AS ?n) {{ ?a {_PATH} ?b . ?c {_PATH} ?d . ?e {_PATH} ?f }}"),
        asked("regular expressions", (200, *STOPPED),
              f'SELECT (COUNT(*) AS ?n) {{ {_NAMES} FILTER(REGEX(STR(?a), "{_EVIL}")) }}'),
        asked("large regular expression", (200, 400, *STOPPED),
              'SELECT * { ?a ?p ?b FILTER(REGEX(STR(?a), "((x{1000}){1000}){1000}")) }'),
        asked("replacing that grows", (200, *STOPPED),
              f'SELECT * {{ BIND("{"a" * 5000}" AS ?x) BIND(REPLACE(?x, "a", ?x) AS ?y) '
              'BIND(REPLACE(?y, "a", ?x) AS ?z) }'),
        asked("a large VALUES block", (200, *STOPPED),
              "SELECT (COUNT(*) AS ?n) { " + " ".join(
                  f"VALUES ?v{n} {{ {' '.join(map(str, range(100)))} }}" for n in range(6)) + " }"),
    ]  # fmt: skip


def _malformed() -> list[Bomb]:
    return [
        asked("nothing", (400,), ""),
        asked("no SPARQL", (400,), "drop table maps;--"),
        asked("no end", (400,), "SELECT * WHERE { ?s ?p"),
        asked("100,000 open brackets", (400, 422), "SELECT * " + "{" * 100_000),
        asked("50,000 nested groups", (400, 422),
              "SELECT * { " + "{ " * 50_000 + "?s ?p ?o" + " }" * 50_000 + " }"),
        asked("100,000 nested brackets", (400, 422),
              "ASK { FILTER(" + "(" * 100_000 + "1" + ")" * 100_000 + ") }"),
        asked("100,000 negations", (400, 422), "ASK { FILTER(" + "!" * 100_000 + "1) }"),
        Bomb("no UTF-8", (400,), b"SELECT * { ?s ?p '\xff\xfe' }"),
        Bomb("zeros", (400,), bytes(500_000)),
        Bomb("10 MB query", (413,), b"SELECT * { ?s ?p '" + b"x" * 10_000_000 + b"' }"),
        Bomb("100 MB query", (0, 413), b"x" * 100_000_000),
        Bomb("10,000 parameters", (400,), b"a=1&" * 10_000, headers=_FORM),
        Bomb("long address", (0, 400, 414, 431), None, "GET", "/sparql?query=" + "x" * 100_000),
        Bomb("long header", (0, 400, 406, 431), None, "GET", headers={"Accept": "x" * 100_000}),
    ]  # fmt: skip


def _reaching_out(elsewhere: str) -> list[Bomb]:
    pattern = "{ ?a ?b ?c }"
    hidden = (
        f"?x afn:a\\' 1 . OPTIONAL {{ SERVICE <http://{elsewhere}/> {pattern} }} ?y afn:b\\' 'x'"
    )
    graph = f"default-graph-uri=http%3A%2F%2F{elsewhere}%2F"
    return [
        asked("SERVICE", (400,), f"SELECT * {{ SERVICE <http://{elsewhere}/> {pattern} }}"),
        asked("SERVICE SILENT", (400,),
              f"SELECT * {{ SERVICE SILENT <http://{elsewhere}/> {pattern} }}"),
        asked("SERVICE by variable", (400,),
              f"SELECT * {{ BIND(<http://{elsewhere}/> AS ?e) SERVICE ?e {pattern} }}"),
        asked("SERVICE behind escapes", (400,), f"SELECT * {{ {hidden} }}"),
        asked("SERVICE in small letters, glued", (400,),
              f"PREFIX e: <http://{elsewhere}/> SELECT * {{ service:x {pattern} }}"),
        asked("FROM the network", (400,), f"SELECT * FROM <http://{elsewhere}/> {pattern}"),
        asked("FROM a file", (400,), f"SELECT * FROM <file:///etc/passwd> {pattern}"),
        asked("LOAD a file", (400,), "LOAD <file:///etc/passwd>"),
        asked("LOAD from the network", (400,), f"LOAD <http://{elsewhere}/>"),
        Bomb("graph from the network", (400,), b"ASK { ?s ?p ?o }", path=f"/sparql?{graph}"),
        Bomb("foreign Host", (403,), b"ASK {}", headers={**QUERY, "Host": "evil.example"}),
        Bomb("foreign page", (403,), b"ASK {}",
             headers={**QUERY, "Origin": "https://evil.example", "Sec-Fetch-Site": "cross-site"}),
    ]  # fmt: skip


def _writing() -> list[Bomb]:
    updates = ("CLEAR ALL", "DROP ALL", "INSERT DATA { <urn:a> <urn:b> <urn:c> }",
               "DELETE WHERE { ?s ?p ?o }", "CREATE GRAPH <urn:x>")  # fmt: skip
    return [
        *(asked(f"as a query: {update}", (400,), update) for update in updates),
        *(Bomb(f"as an update: {u}", (403,), u.encode(), headers=_UPDATE) for u in updates),
        Bomb("in a form", (403,), b"update=CLEAR+ALL", headers=_FORM),
        Bomb("PUT a graph", (405,), b"<urn:a> <urn:b> <urn:c> .", "PUT"),
        Bomb("DELETE a graph", (405,), None, "DELETE", "/sparql?graph=urn:afkb:ontology"),
    ]


def _paths() -> list[Bomb]:
    up = (
        "../" * 12,
        "..%2f" * 12,
        "%2e%2e/" * 12,
        "....//" * 12,
        "..\\" * 12,
        "%252e%252e%252f" * 12,
    )
    roots = ("/", "/static/", "/api/maps/")
    found = [f"{root}{dots}etc/passwd" for root in roots for dots in up]
    found += ["/static//etc/passwd", "/static/%2fetc%2fpasswd", "/static/page.css%00.html",
              "/api/maps/x/why/..%2f..%2fscene.ttl", "/scene.ttl", "/run.json", "//etc/passwd",
              "/static/../app.py", "/static/assets.py"]  # fmt: skip
    return [Bomb(f"path {path[:40]}", (400, 404), None, "GET", path, {}) for path in found]
