"""Whatever a client does, it is answered or refused, and the next one is served."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import psutil
import pytest

from afkb.serving.limits import Limits
from afkb.store import write_map
from serving_samples import Client, served
from store_samples import Names, sample_map

LIMITS = Limits(
    seconds=1.0, memory_mb=64, answer_mb=1, request_kb=64, workers=2, waiting=8,
    patience_s=2.0, connections=64, header_s=1.0, upload_s=1.0,
)  # fmt: skip
STOPPED = (422, 504)
TOO_DEEP = (400, 422)
PRODUCT = "?a ?p ?b . ?c ?q ?d . ?e ?r ?f . ?g ?s ?h"
DOUBLED = " ".join(f"BIND(CONCAT(?x{i}, ?x{i}) AS ?x{i + 1})" for i in range(40))


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_map(tmp_path_factory.mktemp("maps") / "home", sample_map(), {}, [], Names())


@pytest.fixture(scope="module")
def client(home: Path) -> Iterator[Client]:
    with served(home, limits=LIMITS) as client:
        yield client


def is_well(client: Client) -> bool:
    return client.query("ASK { ?r a afn:Room }").body == b'{"head":{},"boolean":true}'


@pytest.mark.parametrize(
    ("sparql", "statuses"),
    [
        (f"SELECT (COUNT(*) AS ?n) {{ {PRODUCT} }}", STOPPED),
        (f"SELECT * {{ {PRODUCT} }}", STOPPED),
        (f"SELECT * {{ {PRODUCT} }} ORDER BY ?h ?f ?d", STOPPED),
        (f'SELECT * {{ BIND("0123456789" AS ?x0) {DOUBLED} }}', STOPPED),
        ("SELECT * { " + "{ " * 15_000 + "?s ?p ?o" + " }" * 15_000 + " }", TOO_DEEP),
        ("ASK { FILTER(" + "(" * 15_000 + "1" + ")" * 15_000 + ") }", TOO_DEEP),
        ("SELECT (COUNT(*) AS ?n) { ?a (!afn:a|^!afn:a)* ?b . ?c (!afn:b|^!afn:b)* ?d "
         ". ?e (!afn:b|^!afn:b)* ?f }", STOPPED),
        ("SELECT * { ?s ?p " + "x" * 70_000 + " }", (413,)),
    ],
    ids=["product", "answer", "sorted", "strings", "groups", "brackets", "paths", "request"],
)  # fmt: skip
def test_a_bomb_is_refused_and_the_next_query_is_answered(
    client: Client, sparql: str, statuses: tuple[int, ...]
) -> None:
    started = time.monotonic()
    reply = client.query(sparql)
    assert reply.status in statuses
    assert "\n" not in reply.error
    assert time.monotonic() - started < 3 * (LIMITS.seconds + LIMITS.patience_s)
    assert is_well(client)


@pytest.mark.parametrize(
    "hidden",
    [
        "SERVICE <http://{}/> {{ ?a ?b ?c }}",
        "SERVICE SILENT <http://{}/> {{ ?a ?b ?c }}",
        # The escaped quotes look like a string to a reader that knows no escapes in names.
        "OPTIONAL {{ ?x afn:a\\' 1 }} SERVICE <http://{}/> {{ ?a ?b ?c }} "
        "OPTIONAL {{ ?y afn:b\\' 'x' }}",
        "FROM <http://{}/>",
    ],
    ids=["plain", "silent", "hidden", "from"],
)
def test_no_query_reaches_another_server(client: Client, hidden: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as elsewhere:
        elsewhere.settimeout(0.2)
        clause = hidden.format(f"127.0.0.1:{elsewhere.getsockname()[1]}")
        inside = clause if "FROM" not in clause else ""
        client.query(f"SELECT * {clause if not inside else ''} WHERE {{ {inside} }}")
        with pytest.raises(TimeoutError):
            elsewhere.accept()


def test_many_clients_are_answered_or_told_to_come_again(client: Client) -> None:
    def ask(number: int) -> int:
        heavy = f"SELECT (COUNT(*) AS ?n) {{ {PRODUCT} }}"
        reply = client.query(heavy if number % 10 == 0 else "ASK { ?r a afn:Room }")
        if reply.status == 503:
            assert int(reply.headers["retry-after"]) > 0
        return reply.status

    with ThreadPoolExecutor(40) as clients:
        statuses = list(clients.map(ask, range(40)))
    assert set(statuses) <= {200, 503, 504}
    assert statuses.count(200) > 0
    assert is_well(client)


def test_a_client_that_sends_slowly_is_cut_off(client: Client) -> None:
    with socket.create_connection(client.address) as slow:
        slow.settimeout(10)
        slow.sendall(b"GET /sparql HTTP/1.1\r\nHost: 127")
        started = time.monotonic()
        assert slow.recv(100) == b""
        assert time.monotonic() - started < 8
    with socket.create_connection(client.address) as slow:
        slow.settimeout(10)
        slow.sendall(
            b"POST /sparql HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n"
            b"Content-Type: application/sparql-query\r\n\r\nASK"
        )
        assert slow.recv(100).startswith(b"HTTP/1.1 408")


def test_more_connections_than_allowed_are_closed_at_once(client: Client) -> None:
    held = [socket.create_connection(client.address) for _ in range(LIMITS.connections + 10)]
    held[-1].settimeout(5)
    try:
        assert held[-1].recv(1) == b""
    except ConnectionResetError:
        pass
    finally:
        for one in held:
            one.close()
    time.sleep(0.1)
    assert is_well(client)


def test_a_query_ends_with_its_client_and_every_process_with_the_server(home: Path) -> None:
    with served(home, limits=Limits(seconds=30, workers=1)) as client:
        body = f"SELECT (COUNT(*) AS ?n) {{ {PRODUCT} . {PRODUCT.upper()} }}"
        head = "POST /sparql HTTP/1.1\r\nHost: localhost\r\n"
        head += f"Content-Type: application/sparql-query\r\nContent-Length: {len(body)}\r\n\r\n"
        with socket.create_connection(client.address) as gone:
            gone.sendall(f"{head}{body}".encode())
            time.sleep(0.5)
        started = time.monotonic()
        assert is_well(client)
        assert time.monotonic() - started < 20
        children = psutil.Process(client.process.pid).children(recursive=True)
        client.process.kill()
        _, alive = psutil.wait_procs(children, timeout=5)
    assert len(children) >= 2
    assert not alive


def test_a_map_that_is_written_anew_is_served_anew(home: Path) -> None:
    with served(home) as client:
        before = client.get("/api/maps").headers["x-afkb-maps"]
        said = client.process.stderr
        assert said is not None
        write_map(home, sample_map(), {}, [], Names())
        assert "loaded anew" in said.readline()
        assert client.get("/api/maps").headers["x-afkb-maps"] != before
        assert is_well(client)
        (home / "scene.ttl").write_text("no Turtle", encoding="utf-8")
        assert "the old one is served" in said.readline()
        assert is_well(client)
