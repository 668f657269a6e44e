"""One client: how long each query of the library takes over HTTP, and by the engine alone.

    python -m bench.serving everyday [--map MAP] [--times N]

The engine alone: the same dataset in this process, answered and written as JSON. One connection for
all, as browsers keep it. Also how long the server takes until it answers, and its memory.
"""

from __future__ import annotations

import argparse
import http.client
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from afkb.knowledge import bundled_ontology
from afkb.serving.answering import answer
from afkb.serving.forms import Question
from afkb.serving.shelf import Shelf
from afkb.store.named import named_queries
from bench.serving.watched import QUERY, Watched, add_map, served

_MOST = 1 << 30


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The map, and how often each query is asked."""
    add_map(parser)
    parser.add_argument("--times", type=int, default=30)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Milliseconds by query."""
    started = time.perf_counter()
    with served(args) as server:
        ready = time.perf_counter() - started
        alone = Shelf.open([_folder(server)], [bundled_ontology()])
        rows = {q.name: _timed(server, alone, q.sparql, args.times) for q in named_queries()}
        return {
            "ready_s": ready if args.map else None,
            "memory_mb": server.memory_mb(),
            "queries": rows,
        }


def _folder(server: Watched) -> Path:
    """The map's folder, from the server's command line."""
    command = list(server.process.args)  # type: ignore[arg-type]
    return Path(str(command[command.index("serve") + 1]))


def _timed(server: Watched, alone: Shelf, sparql: str, times: int) -> dict[str, Any]:
    connection = http.client.HTTPConnection(*server.address, timeout=30)

    def over_http() -> bytes:
        connection.request("POST", "/sparql", sparql.encode(), QUERY)
        return connection.getresponse().read()

    def by_itself() -> bytes:
        return answer(alone, Question(sparql), _MOST)[1]

    told = over_http()
    found = {
        "bytes": len(told),
        "http_ms": _milliseconds(over_http, times),
        "engine_ms": _milliseconds(by_itself, times),
    }
    connection.close()
    return found


def _milliseconds(ask: Callable[[], bytes], times: int) -> dict[str, float]:
    ask()
    taken = []
    for _ in range(times):
        started = time.perf_counter()
        ask()
        taken.append((time.perf_counter() - started) * 1e3)
    half, most = np.percentile(taken, (50, 95))
    return {"median": float(half), "p95": float(most)}


def table(result: dict[str, Any]) -> Iterator[str]:
    """A query a line."""
    if result["ready_s"] is not None:
        yield f"answers {result['ready_s']:.1f} s after it is started"
    yield f"memory {result['memory_mb']:.0f} MB"
    yield f"{'query':<26} {'bytes':>8} {'HTTP ms':>8} {'p95':>7} {'engine ms':>10} {'p95':>7}"
    for name, row in result["queries"].items():
        http_ms, engine = row["http_ms"], row["engine_ms"]
        yield (
            f"{name:<26} {row['bytes']:>8} {http_ms['median']:>8.2f} {http_ms['p95']:>7.2f} "
            f"{engine['median']:>10.2f} {engine['p95']:>7.2f}"
        )
