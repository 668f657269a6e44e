"""Two hundred clients at once: who is answered, how soon, and who is told to come again.

    python -m bench.serving crowd [--map MAP] [--clients N] [--seconds S]

Three crowds, one after the other. `plain`: all ask queries of the library. `patient`: the same,
and whoever is told to come again waits as long as `Retry-After` says. `mixed`: one in ten asks for
a cartesian product. Each client asks again as soon as it is answered, over a new connection.
"""

from __future__ import annotations

import argparse
import threading
import time
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from afkb.store.named import named_queries
from bench.serving.watched import Reply, Watched, add_map, served

_HEAVY = "SELECT (COUNT(*) AS ?n) { ?a ?p ?b . ?c ?q ?d . ?e ?r ?f }"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The map, and how many ask for how long."""
    add_map(parser)
    parser.add_argument("--clients", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=15.0)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Of each crowd: statuses, latencies of the answers and of the refusals, memory."""
    texts = [query.sparql for query in named_queries()]
    kinds = {"plain": (0, False), "patient": (0, True), "mixed": (10, False)}
    with served(args) as server:
        for text in texts:
            server.query(text)
        return {
            name: _crowd(server, texts, args.clients, args.seconds, *how)
            for name, how in kinds.items()
        }


def _crowd(
    server: Watched, texts: list[str], size: int, seconds: float, heavy: int, patient: bool
) -> dict[str, Any]:
    replies: list[Reply] = []
    until = time.perf_counter() + seconds
    server.forget()

    def client(number: int) -> None:
        turn = number
        while time.perf_counter() < until:
            hungry = heavy and number % heavy == 0
            reply = server.query(_HEAVY if hungry else texts[turn % len(texts)])
            replies.append(reply)
            turn += 1
            if patient and reply.status == 503:
                time.sleep(float(reply.headers["retry-after"]))

    clients = [threading.Thread(target=client, args=(n,), daemon=True) for n in range(size)]
    for one in clients:
        one.start()
    for one in clients:
        one.join()
    return _told(replies, server, seconds)


def _told(replies: list[Reply], server: Watched, seconds: float) -> dict[str, Any]:
    answered = [reply.seconds for reply in replies if reply.status == 200]
    refused = [reply.seconds for reply in replies if reply.status == 503]
    return {
        "statuses": dict(sorted(Counter(reply.status for reply in replies).items())),
        "answers_per_second": len(answered) / seconds,
        "answered_s": _spread(answered),
        "refused_s": _spread(refused),
        "peak_mb": server.peak_mb,
    }


def _spread(seconds: list[float]) -> dict[str, float] | None:
    if not seconds:
        return None
    half, most = np.percentile(seconds, (50, 95))
    return {"median": float(half), "p95": float(most), "max": max(seconds)}


def table(result: dict[str, Any]) -> Iterator[str]:
    """A crowd a line; status 0 is a connection that was closed."""
    for name, told in result.items():
        statuses = ", ".join(f"{number} x {status}" for status, number in told["statuses"].items())
        yield f"{name:<8} {statuses}; {told['answers_per_second']:.0f} answers a second"
        for what in ("answered_s", "refused_s"):
            if spread := told[what]:
                yield (
                    f"{'':<8} {what.removesuffix('_s')}: median {spread['median']:.3f} s, "
                    f"p95 {spread['p95']:.3f} s, max {spread['max']:.3f} s"
                )
        yield f"{'':<8} peak memory {told['peak_mb']:.0f} MB"
