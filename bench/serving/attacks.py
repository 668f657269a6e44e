"""Each attack by itself: whether it is answered or refused in bounds, and what it costs.

    python -m bench.serving attacks [--map MAP]

Right is: one of the statuses that belong to the request, no connection to anywhere, no text of a
file that is not served, and an answer to the next plain query. Slow: 100 clients send headers, or
a query, a byte a second; meanwhile plain queries are asked.
"""

from __future__ import annotations

import argparse
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import closing
from typing import Any

from bench.serving.bombs import Bomb, bombs
from bench.serving.watched import Watched, add_map, served

_PLAIN = "ASK { ?room a afn:Room }"
_SLOW_CLIENTS = 100
_SLOW_FOR_S = 15
_SLOW = {
    "slow headers": b"GET /sparql HTTP/1.1\r\nHost: localhost\r\nX: ",
    "slow query": b"POST /sparql HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999\r\n"
    b"Content-Type: application/sparql-query\r\n\r\n",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The map."""
    add_map(parser)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What became of each attack, and the server's memory before, at most, and after."""
    with socket.create_server(("127.0.0.1", 0)) as elsewhere, served(args) as server:
        elsewhere.settimeout(0.0)
        server.query(_PLAIN)
        before = server.memory_mb()
        host = f"127.0.0.1:{elsewhere.getsockname()[1]}"
        rows = [_attacked(server, bomb, elsewhere) for bomb in bombs(host)]
        rows += [_slowed(server, name, begun) for name, begun in _SLOW.items()]
        time.sleep(1.0)
        return {"memory_before_mb": before, "memory_after_mb": server.memory_mb(), "attacks": rows}


def _attacked(server: Watched, bomb: Bomb, elsewhere: socket.socket) -> dict[str, Any]:
    server.forget()
    reply = server.ask(bomb.method, bomb.path, bomb.body, bomb.headers)
    peak = server.peak_mb
    after = server.query(_PLAIN)
    leaked = b"root:" in reply.body or b"@prefix scene" in reply.body
    return {
        "name": bomb.name,
        "status": reply.status,
        "seconds": reply.seconds,
        "peak_mb": peak,
        "next_ms": after.seconds * 1e3,
        "right": reply.status in bomb.right
        and after.status == 200
        and not leaked
        and not _was_asked(elsewhere),
    }


def _was_asked(elsewhere: socket.socket) -> bool:
    try:
        elsewhere.accept()[0].close()
    except BlockingIOError:
        return False
    return True


def _slowed(server: Watched, name: str, begun: bytes) -> dict[str, Any]:
    """Many clients that send a byte a second; whoever is cut off comes again."""
    over = threading.Event()
    clients = [
        threading.Thread(target=_trickle, args=(server.address, begun, over), daemon=True)
        for _ in range(_SLOW_CLIENTS)
    ]
    server.forget()
    started = time.perf_counter()
    for client in clients:
        client.start()
    plain = []
    while time.perf_counter() - started < _SLOW_FOR_S:
        plain.append(server.query(_PLAIN))
        time.sleep(0.1)
    over.set()
    return {
        "name": f"{_SLOW_CLIENTS} clients, {name}",
        "status": max(reply.status for reply in plain),
        "seconds": time.perf_counter() - started,
        "peak_mb": server.peak_mb,
        "next_ms": max(reply.seconds for reply in plain) * 1e3,
        "right": all(reply.status == 200 for reply in plain),
    }


def _trickle(address: tuple[str, int], begun: bytes, over: threading.Event) -> None:
    while not over.is_set():
        with closing(socket.socket()) as line:
            line.settimeout(5)
            try:
                line.connect(address)
                line.sendall(begun)
                while not over.wait(1.0):
                    line.sendall(b"x")
            except OSError:
                continue


def table(result: dict[str, Any]) -> Iterator[str]:
    """An attack a line; those on paths in one."""
    yield f"{'attack':<40} {'status':>6} {'s':>7} {'peak MB':>8} {'next ms':>8}"
    rows = result["attacks"]
    paths = [row for row in rows if row["name"].startswith("path ")]
    for row in rows:
        if row not in paths:
            yield _line(row, row["name"])
    if paths:
        worst = max(paths, key=lambda row: (not row["right"], row["seconds"]))
        yield _line(worst, f"{len(paths)} paths to other files, the worst")
    right = sum(row["right"] for row in rows)
    yield f"{right} of {len(rows)} answered or refused as they should be"
    yield (
        f"memory {result['memory_before_mb']:.0f} MB before, at most "
        f"{max(row['peak_mb'] for row in rows):.0f} MB, {result['memory_after_mb']:.0f} MB after"
    )


def _line(row: dict[str, Any], name: str) -> str:
    told = "" if row["right"] else "  WRONG"
    return (
        f"{name:<40} {row['status']:>6} {row['seconds']:>7.2f} {row['peak_mb']:>8.0f} "
        f"{row['next_ms']:>8.1f}{told}"
    )
