"""The engines, each behind the same two calls: load a file of N-Triples, and ask."""

from __future__ import annotations

import contextlib
import json
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Protocol
from urllib.request import ProxyHandler, Request, build_opener

from bench.detectors.data import NoData

Row = tuple[Any, ...]
_JSON = "application/sparql-results+json"


class Engine(Protocol):
    """What is asked; `ask` gives the rows as plain values."""

    def ask(self, sparql: str) -> list[Row]:
        """The rows of a SELECT."""


class Afkb:
    """Oxigraph within the process, as `afkb.store.Dataset` asks it."""

    def __init__(self, file: Path) -> None:
        from pyoxigraph import RdfFormat, Store

        from afkb.store import Dataset

        store = Store()
        store.bulk_load(path=str(file), format=RdfFormat.N_TRIPLES)
        self._dataset = Dataset(store, {}, {})

    def ask(self, sparql: str) -> list[Row]:
        """The rows of a SELECT."""
        found = self._dataset.ask(sparql)
        return [tuple(_plain(cell.value) for cell in row) for row in found.rows]  # type: ignore[union-attr]


class Rdflib:
    """rdflib's own engine over its own memory."""

    def __init__(self, file: Path) -> None:
        import rdflib

        self._graph = rdflib.Graph().parse(file, format="nt")

    def ask(self, sparql: str) -> list[Row]:
        """The rows of a SELECT."""
        return [tuple(_plain(str(cell)) for cell in row) for row in self._graph.query(sparql)]  # type: ignore[union-attr]


class Owlready:
    """owlready2 over SQLite in memory."""

    def __init__(self, file: Path) -> None:
        import owlready2

        self._world = owlready2.World()
        self._world.get_ontology(file.as_uri()).load()

    def ask(self, sparql: str) -> list[Row]:
        """The rows of a SELECT."""
        rows = self._world.sparql_query(sparql)
        return [tuple(_plain(str(getattr(cell, "iri", cell))) for cell in row) for row in rows]


class OxigraphServer:
    """The Oxigraph server, over HTTP."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._opener = build_opener(ProxyHandler({}))

    def ask(self, sparql: str) -> list[Row]:
        """The rows of a SELECT."""
        request = Request(
            f"{self._url}/query",
            sparql.encode(),
            {
                "Content-Type": "application/sparql-query",
                "Accept": "application/sparql-results+json",
            },
        )
        with self._opener.open(request, timeout=60) as answer:
            found = json.load(answer)
        names = found["head"]["vars"]
        return [
            tuple(_plain(row[name]["value"]) for name in names)
            for row in found["results"]["bindings"]
        ]


@contextlib.contextmanager
def oxigraph_server(file: Path) -> Iterator[OxigraphServer]:
    """A server of its own with that file; raises `NoData` where there is none to start."""
    found = shutil.which("oxigraph", path=str(Path(sys.executable).parent))
    found = found or shutil.which("oxigraph") or _of_the_package()
    if found is None:
        raise NoData("no oxigraph server here: pip install oxigraph")
    with TemporaryDirectory() as folder:
        load = [found, "load", "--location", folder, "--file", str(file)]
        subprocess.run(load, check=True, capture_output=True)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        serve = [found, "serve-read-only", "--location", folder, "--bind", f"127.0.0.1:{port}"]
        process = subprocess.Popen(serve, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            server = OxigraphServer(f"http://127.0.0.1:{port}")
            _wait_for(server)
            yield server
        finally:
            process.kill()
            process.wait()


def _of_the_package() -> str | None:
    from importlib.metadata import PackageNotFoundError, files

    with contextlib.suppress(PackageNotFoundError):
        for file in files("oxigraph") or []:
            if file.name == "oxigraph":
                return str(file.locate())
    return None


def _wait_for(server: OxigraphServer) -> None:
    for _ in range(200):
        try:
            server.ask("SELECT ?x { VALUES ?x { 1 } }")
        except OSError:
            time.sleep(0.05)
        else:
            return
    raise NoData("the oxigraph server does not answer")


def _plain(value: str) -> Any:
    """A number as such, however it is written, and anything else as it stands."""
    try:
        return round(float(value), 6)
    except ValueError:
        return value
