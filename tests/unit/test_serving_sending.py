"""Answers go out as fast as clients take them, and processes end with those who asked."""

from __future__ import annotations

import asyncio
import socket
import threading
from typing import Any

import pytest

from afkb.serving.errors import Refused
from afkb.serving.limits import MB, Limits
from afkb.serving.pool import Keeper, Pool
from afkb.serving.sending import Outgoing


def test_an_answer_counts_until_its_client_has_taken_it() -> None:
    outgoing, body = Outgoing(Limits(outgoing_mb=1)), b"x" * (MB - 1)
    response = outgoing.response({"status": 200, "media": "text/csv"}, body)
    taken: list[bytes] = []

    async def send(message: dict[str, Any]) -> None:
        taken.append(message.get("body", b""))
        if len(taken) == 3:
            with pytest.raises(Refused, match="busy"):
                outgoing.response({"status": 200, "media": "text/csv"}, b"xx")

    asyncio.run(response({"type": "http"}, None, send))  # type: ignore[arg-type]
    assert b"".join(taken) == body and max(map(len, taken)) < len(body) / 8
    outgoing.response({"status": 200, "media": "text/csv"}, b"xx")


class SlowKeeper(Keeper):
    """Forks when it is let, and remembers what it was told to end."""

    def __init__(self) -> None:
        self.begun, self.may = threading.Event(), threading.Event()
        self.ended: list[int] = []

    def fork(self, kind: str) -> tuple[int, socket.socket]:
        self.begun.set()
        self.may.wait(5)
        ours, theirs = socket.socketpair()
        theirs.close()
        return 17, ours

    def end(self, process: int) -> int:
        self.ended.append(process)
        return 0


def test_a_process_whose_client_left_while_it_was_made_is_ended() -> None:
    keeper = SlowKeeper()

    async def leave() -> None:
        pool = Pool(keeper, "asking", 1, 5.0, Limits())
        asking = asyncio.create_task(pool.ask({}))
        await asyncio.to_thread(keeper.begun.wait, 5)
        asking.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asking
        keeper.may.set()
        for _ in range(100):
            if keeper.ended:
                return
            await asyncio.sleep(0.02)

    asyncio.run(leave())
    assert keeper.ended == [17]
