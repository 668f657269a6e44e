"""A time limit for work that can't be interrupted: it is left to itself, and told."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

from afkb.errors import QueryError

T = TypeVar("T")


def within(seconds: float | None, doing: Callable[[], T]) -> T:
    """What `doing` returns; `QueryError` where that takes longer than so many seconds.

    It runs in a thread of its own, so that Ctrl-C works meanwhile. A query that took too long goes
    on in that thread until the program ends: who goes on after it, as a server does, asks in a
    process that can be killed.
    """
    told: list[T] = []
    failed: list[BaseException] = []

    def run() -> None:
        try:
            told.append(doing())
        except BaseException as error:
            failed.append(error)

    thread = threading.Thread(target=run, name="query", daemon=True)
    thread.start()
    thread.join(seconds)
    if thread.is_alive():
        raise QueryError(
            f"no answer within {seconds:g} s; ask for less, with LIMIT or with patterns that share "
            "variables, or give it longer with --timeout"
        )
    if failed:
        raise failed[0]
    return told[0]
