"""What the server's processes do: answer queries, or draw and explain maps; one thing at a time."""

from __future__ import annotations

import socket
from collections.abc import Callable
from functools import partial
from io import BufferedRWPair

from afkb.errors import AfkbError
from afkb.serving.answering import answer
from afkb.serving.channel import ASKING, Head, packed, receive
from afkb.serving.errors import Refused
from afkb.serving.forms import Question
from afkb.serving.limits import MB, Limits
from afkb.serving.sealing import allow_processor_time, has_grown, peak_kb, seal
from afkb.serving.shelf import Shelf


def work(kind: str, channel: socket.socket, shelf: Shelf, limits: Limits) -> None:
    """Answer what comes over the channel until its other end is gone."""
    stream = channel.makefile("rwb")
    if kind == ASKING:
        seal(limits)
        _answer_queries(stream, shelf, limits)
    else:
        _tell(stream, shelf)


def _answer_queries(stream: BufferedRWPair, shelf: Shelf, limits: Limits) -> None:
    at_start = peak_kb()
    while (asked := receive(stream)) is not None:
        allow_processor_time(limits.seconds)
        head, body = _told(partial(_asked, shelf, asked, limits))
        head["tired"] = has_grown(at_start)
        stream.write(packed(head, body))
        stream.flush()


def _tell(stream: BufferedRWPair, shelf: Shelf) -> None:
    from afkb.serving.telling import Teller

    teller = Teller(shelf)
    while (asked := receive(stream)) is not None:
        stream.write(packed(*_told(partial(teller.tell, asked[0]))))
        stream.flush()


def _told(doing: Callable[[], tuple[str, bytes]]) -> tuple[Head, bytes]:
    """What came of it, as a message; what a user can cause is told, the rest ends the process."""
    try:
        media, body = doing()
    except Refused as refused:
        return {"status": refused.status, "error": refused.message}, b""
    except AfkbError as error:
        return {"status": 400, "error": " ".join(str(error).split())}, b""
    except RecursionError:
        return {"status": 400, "error": "the query is nested too deep"}, b""
    return {"status": 200, "media": media}, body


def _asked(shelf: Shelf, asked: tuple[Head, bytes], limits: Limits) -> tuple[str, bytes]:
    head, body = asked
    question = Question(body.decode(), head["default"], head["named"], head["accept"])
    return answer(shelf, question, limits.answer_mb * MB)
