"""The endpoint speaks the SPARQL 1.1 Protocol, for reading."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import urlencode

import pyoxigraph
import pytest

from afkb.store import write_map
from serving_samples import Client, served
from store_samples import Names, sample_map

ROOMS = "SELECT DISTINCT ?r WHERE { ?r a afn:Room } ORDER BY ?r"
FORM = {"Content-Type": "application/x-www-form-urlencoded"}


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    # Two visits of one home: their things have the same IRIs, in two graphs.
    folder = tmp_path_factory.mktemp("maps")
    one = write_map(folder / "my home", sample_map(), {}, [], Names())
    other = write_map(folder / "later" / "my home", sample_map(), {}, [], Names())
    with served(one, other, names=["maps.example"]) as client:
        yield client


def test_the_three_ways_to_ask_give_the_same_answer(client: Client) -> None:
    posted = client.query(ROOMS)
    got = client.get("/sparql?" + urlencode({"query": ROOMS}))
    form = client.ask("POST", "/sparql", urlencode({"query": ROOMS}).encode(), FORM)
    assert posted.status == got.status == form.status == 200
    assert posted.body == got.body == form.body
    assert [row["r"].rpartition("#")[2] for row in posted.rows] == ["room1", "room2"]


@pytest.mark.parametrize(
    ("accept", "media", "begins"),
    [
        ("", "application/sparql-results+json", b'{"head"'),
        ("text/csv", "text/csv", b"r\r\n"),
        ("text/tab-separated-values", "text/tab-separated-values", b"?r\n"),
        ("application/sparql-results+xml", "application/sparql-results+xml", b"<?xml"),
        ("text/csv;q=0.1, application/json", "application/json", b'{"head"'),
    ],
)
def test_rows_come_in_the_form_asked_for(
    client: Client, accept: str, media: str, begins: bytes
) -> None:
    reply = client.query(ROOMS, accept)
    assert reply.headers["content-type"].partition(";")[0] == media
    assert reply.body.startswith(begins)
    assert reply.headers["vary"] == "Accept"


@pytest.mark.parametrize("media", ["text/turtle", "application/n-triples", "application/rdf+xml"])
def test_triples_come_in_the_form_asked_for(client: Client, media: str) -> None:
    reply = client.query("CONSTRUCT { ?r a afn:Room } WHERE { ?r a afn:Room }", media)
    form = pyoxigraph.RdfFormat.from_media_type(media)
    assert len(list(pyoxigraph.parse(reply.body, format=form))) == 2


def test_a_form_that_there_is_not_is_refused_with_those_there_are(client: Client) -> None:
    reply = client.query(ROOMS, "image/png")
    assert reply.status == 406
    assert "text/csv" in reply.error


def test_the_protocol_says_which_graphs_are_asked(client: Client) -> None:
    counted = "SELECT (COUNT(*) AS ?n) WHERE { ?r a afn:Room }"
    graph = "urn:afkb:map:my%20home"
    assert client.query(counted, **{"default-graph-uri": graph}).rows == [{"n": "2"}]
    named = "SELECT DISTINCT ?g WHERE { GRAPH ?g { ?r a afn:Room } }"
    assert len(client.query(named).rows) == 2
    assert client.query(named, **{"named-graph-uri": graph}).rows == [{"g": graph}]
    assert client.query(counted, **{"named-graph-uri": graph}).rows == [{"n": "0"}]


@pytest.mark.parametrize("elsewhere", ["file:///etc/passwd", "http://127.0.0.1:1/x", "x y"])
def test_no_graph_is_ever_fetched(client: Client, elsewhere: str) -> None:
    reply = client.query(ROOMS, **{"default-graph-uri": elsewhere})
    assert reply.status == 400
    assert "urn:afkb:map:my%20home-2" in reply.error


def test_without_a_query_the_endpoint_describes_itself(client: Client) -> None:
    told = client.get("/sparql", Accept="application/n-triples").body.decode()
    assert f"<{client.url}sparql>" in told
    assert "sparql-service-description#SPARQL11Query" in told
    assert "urn:afkb:map:my%20home-2" in told


@pytest.mark.parametrize(
    ("method", "path", "body", "media", "status"),
    [
        ("POST", "/sparql", b"", "application/sparql-query", 400),
        ("POST", "/sparql", b"SELECT", "application/sparql-query", 400),
        ("POST", "/sparql", b"ASK {}\xff", "application/sparql-query", 400),
        ("POST", "/sparql?query=ASK%7B%7D", b"ASK {}", "application/sparql-query", 400),
        ("POST", "/sparql", b"query=%ff", "application/x-www-form-urlencoded", 400),
        ("POST", "/sparql", b"x=1", "application/x-www-form-urlencoded", 400),
        ("POST", "/sparql", b"query=ASK{}&query=ASK{}", "application/x-www-form-urlencoded", 400),
        ("POST", "/sparql", b"x=1&" * 200, "application/x-www-form-urlencoded", 400),
        ("POST", "/sparql", b"ASK {}", "text/plain", 415),
        ("POST", "/sparql", b"ASK {}", "", 415),
        ("POST", "/sparql", b"CLEAR ALL", "application/sparql-update", 403),
        ("POST", "/sparql", b"update=CLEAR+ALL", "application/x-www-form-urlencoded", 403),
        ("POST", "/sparql", b"CLEAR ALL", "application/sparql-query", 400),
        ("GET", "/sparql?update=CLEAR%20ALL", None, "", 403),
        ("GET", "/sparql?other=1", None, "", 400),
        ("PUT", "/sparql", b"", "text/turtle", 405),
        ("DELETE", "/sparql?graph=urn:afkb:ontology", None, "", 405),
        ("POST", "/api/maps", b"", "", 405),
        ("GET", "/nowhere", None, "", 404),
    ],
)
def test_what_is_wrong_is_told_by_status_and_one_line(
    client: Client, method: str, path: str, body: bytes | None, media: str, status: int
) -> None:
    reply = client.ask(method, path, body, {"Content-Type": media} if media else {})
    assert reply.status == status
    assert reply.error.strip()
    assert "\n" not in reply.error


def test_head_and_options_tell_without_asking(client: Client) -> None:
    asked = client.ask("HEAD", "/sparql?" + urlencode({"query": ROOMS}))
    assert (asked.status, asked.body) == (200, b"")
    assert int(asked.headers["content-length"]) == len(client.query(ROOMS).body)
    options = client.ask("OPTIONS", "/sparql")
    assert options.status == 204
    assert options.headers["allow"] == "GET, HEAD, POST, OPTIONS"


def test_two_maps_of_one_name_are_told_apart(client: Client) -> None:
    told = client.get("/api/maps").json
    assert isinstance(told, list)
    assert [m["name"] for m in told] == ["my home", "my home-2"]
    assert {m["nodes"] for m in told} == {6}


def test_a_node_is_explained_and_one_that_there_is_not_is_not(client: Client) -> None:
    told = client.get("/api/maps/my%20home/why/room1").json
    assert isinstance(told, dict)
    assert told["id"] == "room1"
    missing = client.get("/api/maps/my%20home/why/r99")
    assert missing.status == 404
    assert "/" not in missing.error.replace("my home", "")


def test_the_library_of_queries_is_handed_out(client: Client) -> None:
    told = client.get("/api/queries").json
    assert isinstance(told, list)
    assert {"name", "about", "sparql"} <= set(told[0])


def test_without_friends_no_other_site_may_read(client: Client) -> None:
    told = client.get("/api/maps", Origin="https://friend.example")
    assert "access-control-allow-origin" not in told.headers
    assert told.headers["cross-origin-resource-policy"] == "same-origin"
