"""`afkb store push` under kill -9: of the program, and of an Oxigraph server, in turn."""

from __future__ import annotations

import argparse
import socket
import subprocess
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any

import numpy as np

from afkb.errors import EndpointError
from afkb.fleet import Server, map_graph, push
from afkb.fleet.statements import digest_of, statements_of
from afkb.store import load
from bench.detectors.data import NoData
from bench.endurance.killing import WORLD, Moment, add_times, afkb, kill_at, run_to_end

NAME = "home"
AWAY_S = 0.5
"""How long a killed server stays away."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that name its maps."""
    add_times(parser)
    parser.add_argument("--old", type=Path, help="map folder; else two of the bundled home")
    parser.add_argument("--new", type=Path)


class Oxigraph:
    """A server in a process of its own, its data in a folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self._port = free.getsockname()[1]
        self.url = f"http://127.0.0.1:{self._port}"
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start it; it answers a little later."""
        at = ["--location", str(self._folder), "--bind", f"127.0.0.1:{self._port}"]
        null = subprocess.DEVNULL
        self._process = subprocess.Popen([_binary(), "serve", *at], stdout=null, stderr=null)

    def kill(self) -> None:
        """Kill it, as a power cut does."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None


def _binary() -> str:
    with suppress(PackageNotFoundError):
        for file in files("oxigraph") or []:
            if file.name == "oxigraph":
                return str(file.locate())
    raise NoData("no Oxigraph server here: pip install oxigraph")


@contextmanager
def _serving(folder: Path) -> Iterator[Oxigraph]:
    server = Oxigraph(folder)
    server.start()
    try:
        yield server
    finally:
        server.kill()


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What the graph holds after each kill, and after the push was run again."""
    with tempfile.TemporaryDirectory() as scratch:
        folders = args.old or Path(scratch, "old"), args.new or Path(scratch, "new")
        if not (args.old and args.new):
            run_to_end("map", WORLD, "--stop", "2", "--out", folders[0])
            run_to_end("map", WORLD, "--stop", "6", "--out", folders[1])
        with _serving(Path(scratch, "data")) as process:
            rounds = _Rounds(process, folders, np.random.default_rng(args.seed))
            return rounds.run(args.times)


class _Rounds:
    """Round after round: the old map is there, the new one is sent, something is killed."""

    def __init__(
        self, process: Oxigraph, folders: tuple[Path, Path], rng: np.random.Generator
    ) -> None:
        self._process = process
        self._maps = tuple(load(folder) for folder in folders)
        self._digests = {digest_of(statements_of(m)): w for m, w in self._named()}
        self._command = afkb("store", "push", folders[1], "--as", NAME, "--url", process.url)
        self._rng = rng
        self._server = Server.find(process.url)

    def _named(self) -> Iterable[tuple[Any, str]]:
        return zip(self._maps, ("old", "new"), strict=True)

    def run(self, times: int) -> dict[str, Any]:
        """All rounds; every second one kills the server."""
        push(self._server, self._maps[0], NAME)
        whole = self._timed()
        begun = whole - self._sending_s()
        of_program, of_server = Counter[str](), Counter[str]()
        in_the_end, refused = Counter[str](), 0
        for number in range(times):
            push(self._server, self._maps[0], NAME)
            moment = float(self._rng.uniform(begun - 0.1, whole + 0.1))
            if number % 2:
                refused += self._kill_server(moment)
                of_server[self._found()] += 1
            else:
                kill_at(self._command, Moment(moment), [])
                of_program[self._found()] += 1
            push(self._server, self._maps[1], NAME)
            in_the_end[self._found()] += 1
        return {
            "statements": [len(statements_of(m)) for m in self._maps],
            "whole_s": round(whole, 2),
            "kills": times,
            "program_killed": dict(of_program),
            "server_killed": dict(of_server),
            "gave_up": refused,
            "run_again": dict(in_the_end),
            "left_over": self._left_over(),
        }

    def _timed(self) -> float:
        begun = time.monotonic()
        subprocess.run(self._command, check=True, capture_output=True)
        return time.monotonic() - begun

    def _sending_s(self) -> float:
        push(self._server, self._maps[0], NAME)
        begun = time.monotonic()
        push(self._server, self._maps[1], NAME)
        return time.monotonic() - begun

    def _kill_server(self, after_s: float) -> int:
        """Kill the server while the program sends; it comes back. 1 where the program gave up."""
        program = subprocess.Popen(
            self._command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        time.sleep(after_s)
        self._process.kill()
        back = threading.Timer(AWAY_S, self._process.start)
        back.start()
        gave_up = program.wait() != 0
        back.join()
        return int(gave_up)

    def _found(self) -> str:
        try:
            found = digest_of(self._server.triples(map_graph(NAME)))
        except EndpointError as error:
            return str(error)
        return self._digests.get(found, "something else")

    def _left_over(self) -> int:
        """Graphs besides the map's and the catalogue's."""
        rows = self._server.ask("SELECT DISTINCT ?g WHERE { GRAPH ?g { ?s ?p ?o } }")
        return len({row["g"] for row in rows} - {map_graph(NAME), "urn:afkb:maps"})


def table(result: dict[str, Any]) -> Iterable[str]:
    """The result as lines."""
    old, new = result["statements"]
    yield f"{old} statements replaced by {new}; a push takes {result['whole_s']} s"
    for what in ("program_killed", "server_killed", "run_again"):
        found = ", ".join(f"{name} {n}" for name, n in sorted(result[what].items()))
        yield f"  {what.replace('_', ' ')}: {found}"
    yield f"programs that gave up {result['gave_up']}, graphs left over {result['left_over']}"
