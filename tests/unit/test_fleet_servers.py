"""What answers at a URL: servers that are busy, refuse, or are no SPARQL servers at all."""

import socket
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from afkb.errors import EndpointError
from afkb.fleet import Keeper, Server
from afkb.store.http import Address


@pytest.fixture
def odd_server():
    """A server that answers as its path says: `/404`, `/401`, `/301`, `/busy`, `/page`, …"""
    busy = []

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            self.rfile.read(int(self.headers["Content-Length"]))
            what = self.path.split("/")[1]
            if what == "busy" and len(busy) < 2:
                busy.append(self.headers.get("Authorization"))
                self.send_response(503)
                self.end_headers()
                return
            self.send_response(int(what) if what.isdigit() else 200)
            self.send_header("Location", "http://other:secret@elsewhere/sparql?key=hidden")
            self.end_headers()
            text = "<html>what do you <b>want</b>?</html>" + 500 * "x"
            self.wfile.write(b'{"boolean": true}' if what == "busy" else text.encode())

        def log_message(self, *_: object) -> None:
            pass

    http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=http.serve_forever, args=(0.02,), daemon=True).start()
    yield f"http://127.0.0.1:{http.server_port}", busy
    http.shutdown()
    http.server_close()


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("404", "answers no SPARQL query .*404 Not Found: what do you want"),
        ("401", "401 Unauthorized.*name who asks by AFKB_STORE_USER"),
        ("301", "it points to http://elsewhere/sparql: use that URL"),
        ("page", "answers no SPARQL query"),
    ],
)
def test_what_is_no_sparql_server_is_told_in_a_line(odd_server, path, told):
    with pytest.raises(EndpointError, match=told) as error:
        Server.find(f"{odd_server[0]}/{path}")
    assert "secret" not in str(error.value) and "hidden" not in str(error.value)
    assert len(str(error.value)) < 500


def test_a_busy_server_is_asked_again_with_credentials_that_nothing_shows(odd_server):
    url, asked = odd_server
    told = []
    found = Server.find(
        url.replace("//", "//me:s%40crt@") + "/busy", patience_s=10, tell=told.append
    )
    assert asked[0] == "Basic bWU6c0BjcnQ="
    assert "crt" not in repr(found) + str(told) and "bWU6" not in repr(found)


def test_what_refuses_is_told_before_hours_of_mapping(odd_server):
    with pytest.raises(EndpointError, match="401"):
        Keeper.of(f"{odd_server[0]}/401", "", print)


def test_credentials_come_from_the_url_or_the_environment():
    by_token = Address.read("https://h/sparql/", {"AFKB_STORE_TOKEN": "t0k"})
    assert (by_token.url, by_token.authorization) == ("https://h/sparql", "Bearer t0k")
    by_user = {"AFKB_STORE_USER": "me", "AFKB_STORE_PASSWORD": "pw"}
    assert Address.read("http://h", by_user).authorization == "Basic bWU6cHc="
    assert Address.read("http://h", by_user).shows_credentials
    assert not Address.read("http://localhost", by_user).shows_credentials
    assert Address.read("http://[::1]:80/x", {}) == Address("http://[::1]:80/x")


@pytest.mark.parametrize("url", ["ftp://host", "my-map", "http://", "http://u:pw@h:port/"])
def test_what_is_no_url_of_a_server_is_refused_without_repeating_it(url):
    with pytest.raises(EndpointError) as error:
        Address.read(url)
    assert "pw" not in str(error.value)


@pytest.mark.parametrize(
    ("number", "told"),
    [
        (socket.EAI_NONAME, "no such host"),
        (socket.EAI_AGAIN, "looked up now; given up after 0.1 s"),
    ],
)
def test_a_misspelt_host_is_told_at_once_and_a_lost_network_waited_for(monkeypatch, number, told):
    def lookup(*_: object) -> None:
        raise socket.gaierror(number, "said by the system")

    monkeypatch.setattr(socket, "getaddrinfo", lookup)
    with pytest.raises(EndpointError, match=told):
        Server.find("http://maps.example", patience_s=0.1)
