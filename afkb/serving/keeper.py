"""The process that has the maps in memory, and forks those that answer.

It runs nothing but this loop, in one thread, so that a fork is safe, takes milliseconds, and shares
the maps' memory. A query that takes too long is killed with its process; the next is forked.

Started by the server as `python -m afkb.serving.keeper FD`; settings come over standard input.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
import traceback
from contextlib import suppress
from pathlib import Path

from afkb.errors import AfkbError
from afkb.serving.channel import Head, packed
from afkb.serving.limits import Limits
from afkb.serving.shelf import Shelf
from afkb.serving.worker import work

REQUEST_BYTES = 4096
"""No request to the keeper is longer."""


def keep(control: socket.socket, settings: Head) -> None:
    """Load the maps, say so, and fork and end processes as asked until the server is gone."""
    limits = Limits(**settings["limits"])
    try:
        shelf = Shelf.open(
            [Path(folder) for folder in settings["maps"]],
            [Path(file) for file in settings["ontology"]],
        )
    except AfkbError as error:
        control.sendall(packed({"error": str(error)}))
        return
    control.sendall(packed({"maps": shelf.listed(), "graphs": shelf.graph_names()}))
    _import_what_queries_need()
    children: set[int] = set()
    try:
        _loop(control, shelf, limits, children)
    finally:
        for child in children:
            _end(child)


def _loop(control: socket.socket, shelf: Shelf, limits: Limits, children: set[int]) -> None:
    while True:
        written, handles, _, _ = socket.recv_fds(control, REQUEST_BYTES, 1)
        if not written:
            return
        asked = json.loads(written)
        if handles:
            try:
                child = _fork(asked["kind"], handles[0], control, shelf, limits)
            except OSError as error:
                # The machine is short of something; the server tells the client to come again.
                control.sendall(packed({"error": str(error)}))
                continue
            children.add(child)
            control.sendall(packed({"process": child}))
        else:
            children.remove(asked["end"])
            control.sendall(packed({"status": _end(asked["end"])}))


def _fork(kind: str, handle: int, control: socket.socket, shelf: Shelf, limits: Limits) -> int:
    """A process of that kind on the other end of a socket; its number."""
    with socket.socket(fileno=handle) as channel:
        process = os.fork()
        if process == 0:
            code = 1
            try:
                control.close()
                work(kind, channel, shelf, limits)
                code = 0
            except Exception:
                traceback.print_exc()  # To the server's log; what is sealed has none.
            finally:
                os._exit(code)
    return process


def _end(process: int) -> int:
    """Kill a child, if it lives, and return how it ended: an exit code, or a signal as negative.

    Children are waited for here and nowhere else, so that the number can't be another's by now.
    """
    done, status = os.waitpid(process, os.WNOHANG)
    if done == 0:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
        _, status = os.waitpid(process, 0)
    return os.waitstatus_to_exitcode(status)


def _import_what_queries_need() -> None:
    """Once sealed, a process can't import any more."""
    import rdflib.plugins.sparql.parser  # noqa: F401


def _main() -> None:
    control = socket.socket(fileno=int(sys.argv[1]))
    settings = json.load(sys.stdin)
    keep(control, settings)


if __name__ == "__main__":
    _main()
