"""A web page of someone else gets nothing from the server, and no path leads out of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from afkb.store import write_map
from serving_samples import Client, served
from store_samples import Names, sample_map

FRIEND = "https://friend.example"


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_map(tmp_path_factory.mktemp("maps") / "home", sample_map(), {}, [], Names())


@pytest.fixture(scope="module")
def client(home: Path) -> Iterator[Client]:
    with served(home, names=["maps.example"], origins=[FRIEND]) as client:
        yield client


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "", "[x]", "home"])
def test_a_foreign_name_for_this_machine_is_refused(client: Client, host: str) -> None:
    reply = client.get("/api/maps", Host=host)
    assert reply.status == 403
    assert "--name" in reply.error


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8000", "localhost", "LOCALHOST:1", "[::1]:8000", "maps.example", "10.1.2.3"]
)
def test_an_address_or_a_name_that_was_given_is_not(client: Client, host: str) -> None:
    assert client.get("/api/maps", Host=host).status == 200


def test_another_sites_page_may_ask_only_if_it_was_named(client: Client) -> None:
    foreign = {"Sec_Fetch_Site": "cross-site", "Sec_Fetch_Mode": "cors"}
    evil = client.get("/api/maps", Origin="https://evil.example", **foreign)
    friend = client.get("/api/maps", Origin=FRIEND, **foreign)
    assert (evil.status, friend.status) == (403, 200)
    assert "access-control-allow-origin" not in evil.headers
    assert friend.headers["access-control-allow-origin"] == FRIEND


def test_a_link_from_another_site_may_be_followed(client: Client) -> None:
    headers = {"Sec_Fetch_Site": "cross-site", "Sec_Fetch_Mode": "navigate"}
    assert client.get("/api/maps", **headers).status == 200


def test_a_preflight_is_answered_for_friends(client: Client) -> None:
    asked = {"Access-Control-Request-Method": "POST", "Origin": FRIEND}
    assert client.ask("OPTIONS", "/sparql", None, asked).status == 200
    strange = asked | {"Origin": "https://evil.example"}
    told = client.ask("OPTIONS", "/sparql", None, strange)
    assert "access-control-allow-origin" not in told.headers


@pytest.mark.parametrize("path", ["/", "/nowhere", "/api/maps", "/sparql?query=SELECT"])
def test_every_answer_is_signed(client: Client, path: str) -> None:
    headers = client.get(path).headers
    assert "default-src 'none'" in headers["content-security-policy"]
    assert "unsafe" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    assert "server" not in headers


@pytest.mark.parametrize(
    "path",
    [
        "/static/../__init__.py",
        "/static/..%2f__init__.py",
        "/static/..%2f..%2f..%2f..%2f..%2fetc%2fpasswd",
        "/static//etc/passwd",
        "/static/%2fetc%2fpasswd",
        "/static/serve.html%00",
        "/api/maps/..%2fhome/plan",
        "/api/maps/home/why/..%2f..%2fscene.ttl",
        "/../../../../etc/passwd",
        "/home/scene.ttl",
    ],
)
def test_no_path_leads_to_another_file(client: Client, path: str) -> None:
    reply = client.get(path)
    assert reply.status == 404
    assert b"root:" not in reply.body


def test_the_page_and_its_files_are_not_sent_twice(client: Client) -> None:
    page = client.get("/static/page.css")
    assert page.status == 200
    assert page.headers["content-type"].startswith("text/css")
    again = client.get("/static/page.css", If_None_Match=page.headers["etag"])
    assert (again.status, again.body) == (304, b"")
