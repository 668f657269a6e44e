"""The server's side of its processes: who is free, who takes too long, who has died."""

from __future__ import annotations

import asyncio
import json
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from afkb.errors import MapError
from afkb.serving.channel import Head, packed, receive, receive_soon
from afkb.serving.errors import Refused, ServingError, busy
from afkb.serving.limits import Limits


class Keeper:
    """The keeper's process and the line to it; its calls block for some milliseconds."""

    def __init__(self, folders: Sequence[Path], ontology: Sequence[Path], limits: Limits) -> None:
        self._lock = threading.Lock()
        self._control, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "afkb.serving.keeper", str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.PIPE,
                start_new_session=True,  # Ctrl-C is the server's affair.
            )
        settings = {
            "maps": [str(folder.resolve()) for folder in folders],
            "ontology": [str(file.resolve()) for file in ontology],
            "limits": asdict(limits),
        }
        assert self._process.stdin is not None
        with self._process.stdin as stdin:
            stdin.write(json.dumps(settings).encode())
        self._answers = self._control.makefile("rb")

    def ready(self) -> Head:
        """Wait until the maps are loaded: `maps` and `graphs`; `MapError` where they can't be."""
        told = self._told()
        if "error" in told:
            raise MapError(told["error"])
        return told

    def fork(self, kind: str) -> tuple[int, socket.socket]:
        """A new process of that kind, and the line to it."""
        ours, theirs = socket.socketpair()
        with theirs:
            try:
                told = self._asked({"kind": kind}, [theirs.fileno()])
                if "error" in told:
                    raise ServingError(f"no process could be forked ({told['error']})")
            except ServingError:
                ours.close()
                raise
        return told["process"], ours

    def end(self, process: int) -> int:
        """End a process; how it ended: an exit code, or the signal that ended it as negative."""
        return int(self._asked({"end": process}, [])["status"])

    def _asked(self, request: Head, handles: list[int]) -> Head:
        with self._lock:
            try:
                socket.send_fds(self._control, [json.dumps(request).encode()], handles)
            except OSError as error:
                raise ServingError(f"the process that keeps the maps is gone ({error})") from error
            return self._told()

    def _told(self) -> Head:
        message = receive(self._answers)
        if message is None:
            raise ServingError("the process that keeps the maps ended; is there memory enough?")
        return message[0]

    @property
    def is_gone(self) -> bool:
        """Whether the process has ended."""
        return self._process.poll() is not None

    def close(self) -> None:
        """End it and all that it forked."""
        self._control.shutdown(socket.SHUT_RDWR)
        try:
            self._process.wait(2.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._answers.close()
        self._control.close()


@dataclass
class _Worker:
    process: int
    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter

    async def exchange(self, head: Head, body: bytes) -> tuple[Head, bytes]:
        """What it answers; `EOFError` or `ConnectionError` where it dies instead."""
        self.writer.write(packed(head, body))
        await self.writer.drain()
        return await receive_soon(self.reader)


class Pool:
    """So many processes of one kind, and those who wait for one; an answer may take `seconds`."""

    def __init__(
        self, keeper: Keeper, kind: str, size: int, seconds: float, limits: Limits
    ) -> None:
        self._keeper = keeper
        self._kind = kind
        self._seconds = seconds
        self._limits = limits
        self._free: asyncio.Queue[_Worker | None] = asyncio.Queue()
        for _ in range(size):
            self._free.put_nowait(None)
        self._waiting = 0
        self._ending: set[asyncio.Task[int]] = set()

    async def ask(self, head: Head, body: bytes = b"") -> tuple[Head, bytes]:
        """The answer of the next free process.

        `Refused` where there is none soon, or where it took too long or too much. If this is
        cancelled, since the client is gone, the process is killed and the query ends.
        """
        worker = await self._turn()
        kept: _Worker | None = None
        try:
            worker = worker or await self._fork()
            exchange = worker.exchange(head, body)
            told, content = await asyncio.wait_for(exchange, self._seconds)
            kept = None if told.get("tired") else worker
            return told, content
        except TimeoutError:
            raise self._took_too_long() from None
        except (EOFError, ConnectionError):
            assert worker is not None
            ended, worker = worker, None
            raise self._died(await self._end(ended)) from None
        except ServingError:
            raise busy(2) from None  # The keeper may be gone; then another is on its way.
        finally:
            if kept is None and worker is not None:
                self._ending.add(ending := asyncio.create_task(self._end(worker)))
                ending.add_done_callback(self._ending.discard)
            self._free.put_nowait(kept)

    async def _turn(self) -> _Worker | None:
        """A free process, or None for one that has yet to be forked."""
        if self._free.empty() and self._waiting >= self._limits.waiting:
            raise busy()
        self._waiting += 1
        try:
            async with asyncio.timeout(self._limits.patience_s):
                return await self._free.get()
        except TimeoutError:
            raise busy(2) from None
        finally:
            self._waiting -= 1

    async def _fork(self) -> _Worker:
        forking = asyncio.ensure_future(asyncio.to_thread(self._keeper.fork, self._kind))
        try:
            process, line = await asyncio.shield(forking)
        except asyncio.CancelledError:
            forking.add_done_callback(self._abandon)
            raise
        return _Worker(process, *await asyncio.open_unix_connection(sock=line))

    def _abandon(self, forking: asyncio.Future[tuple[int, socket.socket]]) -> None:
        """End a process whose client went away before it was there."""
        if forking.cancelled() or forking.exception() is not None:
            return
        process, line = forking.result()
        line.close()
        ending = asyncio.ensure_future(asyncio.to_thread(self._keeper.end, process))
        ending.add_done_callback(lambda done: done.cancelled() or done.exception())

    async def _end(self, worker: _Worker) -> int:
        """End a process; how it ended."""
        worker.writer.close()
        try:
            return await asyncio.to_thread(self._keeper.end, worker.process)
        except ServingError:
            return -signal.SIGKILL

    def _took_too_long(self) -> Refused:
        return Refused(504, f"stopped after {self._seconds:g} s, the time limit; ask for less")

    def _died(self, status: int) -> Refused:
        """What to say of a process that a query has ended, by how it ended."""
        if status == -signal.SIGXCPU:
            return self._took_too_long()
        return Refused(
            422,
            f"stopped: it needs more than {self._limits.memory_mb} MB of memory, or is nested "
            "too deep; ask for less",
        )
