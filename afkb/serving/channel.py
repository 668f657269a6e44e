"""Messages between the server and its processes: a JSON head and bytes, each with its length.

No pickles: a process that a query has led astray can send bytes and nothing that runs.
"""

from __future__ import annotations

import asyncio
import json
import struct
from typing import Any, Protocol

Head = dict[str, Any]
Message = tuple[Head, bytes]
ASKING = "asking"
"""The kind of process that runs strangers' queries, sealed."""
TELLING = "telling"
"""The kind that runs none, and draws and explains maps."""
_LENGTHS = struct.Struct("!II")


def packed(head: Head, body: bytes = b"") -> bytes:
    r"""A message as it goes over a socket.

    >>> packed({}, b"!")
    b'\x00\x00\x00\x02\x00\x00\x00\x01{}!'
    """
    written = json.dumps(head).encode()
    return _LENGTHS.pack(len(written), len(body)) + written + body


class Readable(Protocol):
    """A stream whose `read` waits until it has all, or the other end is gone."""

    def read(self, size: int, /) -> bytes:
        """So many bytes, fewer at the end."""
        ...


def receive(stream: Readable) -> Message | None:
    """The next message of a blocking stream; None where the other end is gone."""
    lengths = stream.read(_LENGTHS.size)
    if len(lengths) < _LENGTHS.size:
        return None
    head_length, body_length = _LENGTHS.unpack(lengths)
    head, body = stream.read(head_length), stream.read(body_length)
    if len(head) < head_length or len(body) < body_length:
        return None
    return json.loads(head), body


async def receive_soon(reader: asyncio.StreamReader) -> Message:
    """The next message; `EOFError` where the other end is gone."""
    head_length, body_length = _LENGTHS.unpack(await reader.readexactly(_LENGTHS.size))
    head = json.loads(await reader.readexactly(head_length))
    return head, await reader.readexactly(body_length)
