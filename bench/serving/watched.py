"""A server as users start it, its memory watched, and requests to it that are timed."""

from __future__ import annotations

import argparse
import http.client
import json
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

import psutil  # type: ignore[import-untyped]

_LOOK_S = 0.05
_PATIENCE_S = 60.0
QUERY = {"Content-Type": "application/sparql-query", "Accept": "application/sparql-results+json"}


@dataclass(frozen=True, slots=True)
class Reply:
    """What came back: 0 where the connection was closed instead; seconds until it was there."""

    status: int
    seconds: float
    body: bytes = b""
    headers: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Watched:
    """A running server and the most memory that it took since `forget`, MB."""

    process: subprocess.Popen[str]
    address: tuple[str, int]
    map_name: str
    peak_mb: float = 0.0
    _over: threading.Event = field(default_factory=threading.Event)

    def ask(
        self, method: str, path: str, body: bytes | None = None, headers: Mapping[str, str] = {}
    ) -> Reply:
        """One request over a connection of its own."""
        started = time.perf_counter()
        connection = http.client.HTTPConnection(*self.address, timeout=_PATIENCE_S)
        try:
            connection.request(method, path, body, dict(headers))
            found = connection.getresponse()
            content = found.read()
        except (OSError, http.client.HTTPException):
            return Reply(0, time.perf_counter() - started)
        finally:
            connection.close()
        told = {name.lower(): value for name, value in found.getheaders()}
        return Reply(found.status, time.perf_counter() - started, content, told)

    def query(self, sparql: str) -> Reply:
        """A query, posted."""
        return self.ask("POST", "/sparql", sparql.encode(), QUERY)

    def forget(self) -> None:
        """Begin to measure memory anew."""
        self.peak_mb = self.memory_mb()

    def memory_mb(self) -> float:
        """What all its processes take now."""
        total = 0
        try:
            whole = psutil.Process(self.process.pid)
            tree = [whole, *whole.children(recursive=True)]
        except psutil.Error:
            return 0.0
        for process in tree:
            try:
                total += process.memory_full_info().pss
            except (psutil.Error, OSError):
                continue  # It has just been ended.
        return total / 1e6

    def watch(self) -> None:
        """Look at the memory until the end."""
        while not self._over.wait(_LOOK_S):
            self.peak_mb = max(self.peak_mb, self.memory_mb())

    def end(self) -> None:
        """Ctrl-C."""
        self._over.set()
        self.process.send_signal(signal.SIGINT)
        self.process.wait(30)


def add_map(parser: argparse.ArgumentParser) -> None:
    """The option that names the map."""
    parser.add_argument("--map", type=Path, help="a map; else the bundled home is mapped")


@contextmanager
def served(args: argparse.Namespace) -> Iterator[Watched]:
    """A server of the map that is asked for."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.map
        if folder is None:
            folder = Path(scratch) / "demo-map"
            _afkb("demo", "--out", str(folder)).communicate()
        process = _afkb("serve", str(folder), "--port", "0", "--json")
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        url = urlsplit(told["url"])
        assert url.hostname is not None and url.port is not None
        server = Watched(process, (url.hostname, url.port), told["maps"][0]["name"])
        watcher = threading.Thread(target=server.watch, daemon=True)
        watcher.start()
        try:
            yield server
        finally:
            server.end()


def _afkb(*arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "afkb.cli.app", *arguments], stdout=subprocess.PIPE, text=True
    )
