"""A server of the small home as a process of its own, and a client that hides nothing."""

from __future__ import annotations

import http.client
import json
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from urllib.parse import urlencode, urlsplit

from afkb.serving.limits import Limits

_SERVE = """
import json, sys
from pathlib import Path
from afkb.serving.limits import Limits
from afkb.serving.running import Address, serve
told = json.loads(sys.argv[1])
serve(
    [Path(m) for m in told["maps"]], [], Address(port=0, **told["address"]),
    Limits(**told["limits"]), lambda url, maps: print(url, flush=True),
    lambda line: print(line, file=sys.stderr, flush=True),
)
"""


USUAL = Limits()


@dataclass(frozen=True)
class Reply:
    status: int
    headers: Mapping[str, str]
    body: bytes

    @property
    def json(self) -> object:
        return json.loads(self.body)

    @property
    def error(self) -> str:
        return str(json.loads(self.body)["error"])

    @property
    def rows(self) -> list[dict[str, str]]:
        bindings = json.loads(self.body)["results"]["bindings"]
        return [{name: cell["value"] for name, cell in row.items()} for row in bindings]


@dataclass(frozen=True)
class Client:
    """One connection a request; header names of replies are in lower case."""

    url: str
    process: subprocess.Popen[str]

    @property
    def address(self) -> tuple[str, int]:
        parts = urlsplit(self.url)
        assert parts.hostname is not None and parts.port is not None
        return parts.hostname, parts.port

    def ask(
        self, method: str, path: str, body: bytes | None = None, headers: Mapping[str, str] = {}
    ) -> Reply:
        connection = http.client.HTTPConnection(*self.address, timeout=20)
        try:
            connection.request(method, path, body, dict(headers))
            response = connection.getresponse()
            found = {name.lower(): value for name, value in response.getheaders()}
            return Reply(response.status, found, response.read())
        finally:
            connection.close()

    def get(self, path: str, **headers: str) -> Reply:
        return self.ask("GET", path, None, {k.replace("_", "-"): v for k, v in headers.items()})

    def query(self, sparql: str, accept: str = "", **parameters: str) -> Reply:
        path = "/sparql" + (f"?{urlencode(parameters)}" if parameters else "")
        headers = {"Content-Type": "application/sparql-query"} | (
            {"Accept": accept} if accept else {}
        )
        return self.ask("POST", path, sparql.encode(), headers)


@contextmanager
def served(*maps: Path, limits: Limits = USUAL, **address: object) -> Iterator[Client]:
    """A server of these maps, without the ontology, on a free port."""
    told = {"maps": [str(m) for m in maps], "address": address, "limits": asdict(limits)}
    process = subprocess.Popen(
        [sys.executable, "-c", _SERVE, json.dumps(told)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    try:
        yield Client(process.stdout.readline().strip(), process)
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
