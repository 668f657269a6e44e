"""`afkb query --endpoint`: against a small server that does as the test says."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs

import pytest
from pyoxigraph import NamedNode, QueryResultsFormat, QueryTriples, RdfFormat, serialize

from afkb.errors import EndpointError, QueryError
from afkb.store import Dataset, load, write_map
from afkb.store.sparql_remote import query_endpoint
from store_samples import Names, sample_map

Answer = tuple[int, str, bytes]


class Server:
    """Answers as `answer` says, given the form that was sent; `forms`: all that was sent."""

    def __init__(self, answer: Callable[[dict[str, list[str]]], Answer]) -> None:
        self.forms: list[dict[str, list[str]]] = []
        self.answer = answer
        outer = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                length = int(self.headers["Content-Length"])
                form = parse_qs(self.rfile.read(length).decode())
                outer.forms.append(form)
                status, media, body = outer.answer(form)
                self.send_response(status)
                self.send_header("Content-Type", media)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_: object) -> None:
                return

        self.http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.http.server_address[1]}/query"
        threading.Thread(target=self.http.serve_forever, daemon=True).start()


@pytest.fixture
def serve() -> Iterator[Callable[[Callable[[dict[str, list[str]]], Answer]], Server]]:
    started: list[Server] = []

    def start(answer: Callable[[dict[str, list[str]]], Answer]) -> Server:
        started.append(Server(answer))
        return started[-1]

    yield start
    for server in started:
        server.http.shutdown()
        server.http.server_close()


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    folder = tmp_path_factory.mktemp("maps") / "home"
    return Dataset.load([load(write_map(folder, sample_map(), {}, [], Names()))])


def answering(home: Dataset, *, xml: bool = False) -> Callable[[dict[str, list[str]]], Answer]:
    """As a server that has the map in its default graph and declares no prefix."""

    def answer(form: dict[str, list[str]]) -> Answer:
        graphs = [NamedNode(name) for name in form.get("default-graph-uri", [])] or None
        found = home.store.query(
            form["query"][0], use_default_graph_as_union=not graphs, default_graph=graphs
        )
        if isinstance(found, QueryTriples):
            return 200, "text/turtle", serialize(found, format=RdfFormat.TURTLE) or b""
        form_of = QueryResultsFormat.XML if xml else QueryResultsFormat.JSON
        return 200, form_of.media_type, found.serialize(format=form_of) or b""

    return answer


@pytest.mark.parametrize("xml", [False, True])
def test_a_server_answers_as_the_map_itself_does(serve, home: Dataset, xml: bool) -> None:  # type: ignore[no-untyped-def]
    server = serve(answering(home, xml=xml))
    for sparql in (
        "SELECT ?n ?e ?none { ?n a afn:ObservedEntity ; afn:existence ?e } ORDER BY ?n",
        "ASK { ?r a afn:Room }",
        "CONSTRUCT { ?n a skos:Concept } WHERE { ?n a afn:RobotPlace }",
        "SELECT ?s { scene:n2 afn:supportedBy ?s }",
    ):
        here, there = home.ask(sparql), query_endpoint(server.url, sparql)
        assert (here.columns, here.rows, here.truth) == (there.columns, there.rows, there.truth)


def test_graphs_go_along(serve, home: Dataset) -> None:  # type: ignore[no-untyped-def]
    server = serve(answering(home))
    asked = "SELECT (COUNT(*) AS ?n) { ?s a afn:Room }"
    assert query_endpoint(server.url, asked, ["urn:afkb:map:home"]).cells() == [("2",)]
    assert query_endpoint(server.url, asked, ["urn:x"]).cells() == [("0",)]
    assert server.forms[-1]["default-graph-uri"] == ["urn:x"]
    assert server.forms[-1]["query"][0].startswith("PREFIX afn: <")


def test_what_is_no_sparql_is_told_in_one_line(serve, home: Dataset) -> None:  # type: ignore[no-untyped-def]
    page = serve(lambda form: (200, "text/html", b"<h1>Welcome</h1>"))
    with pytest.raises(EndpointError, match="text/html, which is no SPARQL result; is that the"):
        query_endpoint(page.url, "ASK { ?s ?p ?o }")
    cut = serve(lambda form: (200, "application/sparql-results+json", b'{"head": {}, "resu'))
    with pytest.raises(EndpointError, match="can't be read as application/sparql-results"):
        query_endpoint(cut.url, "ASK { ?s ?p ?o }")
    refusing = serve(lambda form: (400, "text/plain", b"unknown function\n" + b"x" * 9000))
    with pytest.raises(EndpointError, match=r"400 Bad Request: unknown function x+…$") as told:
        query_endpoint(refusing.url, "ASK { ?s ?p ?o }")
    assert len(str(told.value)) < 400
    empty = serve(lambda form: (200, "text/tab-separated-values", b"?map\n"))
    with pytest.raises(EndpointError, match="has no map there, so scene: stands for nothing"):
        query_endpoint(empty.url, "ASK { scene:n1 ?p ?o }")


def test_a_slow_and_an_absent_server_are_told(serve, home: Dataset) -> None:  # type: ignore[no-untyped-def]
    def slow(form: dict[str, list[str]]) -> Answer:
        time.sleep(0.4)
        return 200, "text/plain", b""

    with pytest.raises(EndpointError, match=r"no answer within 0\.1 s"):
        query_endpoint(serve(slow).url, "ASK { ?s ?p ?o }", timeout_s=0.1)
    with pytest.raises(EndpointError, match="nobody listens there"):
        query_endpoint("http://127.0.0.1:9/query", "ASK { ?s ?p ?o }")


def test_a_slip_or_an_update_is_told_before_anything_is_sent(serve, home: Dataset) -> None:  # type: ignore[no-untyped-def]
    server = serve(answering(home))
    with pytest.raises(QueryError, match="line 2, column 3"):
        query_endpoint(server.url, "SELECT * {\n  FLTER(?o) }")
    with pytest.raises(QueryError, match="read-only"):
        query_endpoint(server.url, "DELETE WHERE { ?s ?p ?o }")
    assert server.forms == []
