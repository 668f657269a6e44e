"""Answers on their way: dropped when the client is gone, and never too many at once."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any, TypeVar

from starlette.requests import Request
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from afkb.serving.channel import Head
from afkb.serving.errors import Refused, busy
from afkb.serving.limits import MB, Limits

T = TypeVar("T")


class Outgoing:
    """How many bytes of answers wait to be taken by slow clients; there is a limit to that."""

    def __init__(self, limits: Limits) -> None:
        self._most = limits.outgoing_mb * MB
        self._bytes = 0

    def response(self, head: Head, body: bytes) -> Response:
        """What a process told as a response; `Refused` for an error, or where too much waits."""
        if head["status"] != 200:
            raise Refused(head["status"], head["error"])
        if self._bytes + len(body) > self._most:
            raise busy()
        return _Counted(self, body, head["media"])

    def add(self, number: int) -> None:
        """Count bytes that go out, or with a negative number such as have gone."""
        self._bytes += number


_PIECE = 1 << 16
"""Bytes that are sent at once: the next ones go when the client has taken these."""


class _Counted(Response):
    """A response that is sent piece by piece, whose bytes count until the client has taken them."""

    def __init__(self, outgoing: Outgoing, body: bytes, media: str) -> None:
        super().__init__(body, media_type=media, headers={"Vary": "Accept"})
        self._outgoing = outgoing

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        self._outgoing.add(len(self.body))
        begin = {"status": self.status_code, "headers": self.raw_headers}
        try:
            await send({"type": "http.response.start", **begin})
            for at in range(0, len(self.body), _PIECE):
                piece = bytes(self.body[at : at + _PIECE])
                await send({"type": "http.response.body", "body": piece, "more_body": True})
            await send({"type": "http.response.body", "body": b"", "more_body": False})
        finally:
            self._outgoing.add(-len(self.body))


async def while_connected(request: Request, asking: Coroutine[Any, Any, T]) -> T:
    """What is asked for, unless the client goes away: then it is cancelled, and nobody listens."""
    answer = asyncio.create_task(asking)
    gone = asyncio.create_task(_gone(request))
    try:
        await asyncio.wait({answer, gone}, return_when=asyncio.FIRST_COMPLETED)
        if answer.done():
            return answer.result()
        raise Refused(499, "the client went away")
    finally:
        gone.cancel()
        answer.cancel()


async def _gone(request: Request) -> None:
    """Return when the client has closed the connection."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
