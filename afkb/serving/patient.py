"""HTTP connections that wait for a client, but not for ever.

uvicorn bounds how long an idle connection is kept, but neither how slowly headers may come nor how
slowly an answer may be taken.
"""

from __future__ import annotations

import asyncio
import socket

from uvicorn.protocols.http.h11_impl import H11Protocol

from afkb.serving.limits import Limits


def patient_protocol(limits: Limits) -> type[H11Protocol]:
    """The class of connections that are cut when a client is slower than the limits allow."""

    class PatientProtocol(H11Protocol):
        """One connection; beyond the number that may be open it is cut at once."""

        _headers_due: asyncio.TimerHandle | None = None
        _reading_due: asyncio.TimerHandle | None = None

        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            super().connection_made(transport)
            if len(self.connections) > limits.connections:
                transport.abort()
                return
            # Headers and body are written one after the other; else the body waits 40 ms for the
            # client to say that it has the headers.
            transport.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._expect_headers()

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            if self.cycle is not None and not self.cycle.response_complete:
                self._stop("_headers_due")
            elif self._headers_due is None:
                self._expect_headers()

        def pause_writing(self) -> None:
            super().pause_writing()
            if self._reading_due is None:
                self._reading_due = self.loop.call_later(limits.stalled_s, self.transport.abort)

        def resume_writing(self) -> None:
            super().resume_writing()
            self._stop("_reading_due")

        def connection_lost(self, exc: Exception | None) -> None:
            self._stop("_headers_due")
            self._stop("_reading_due")
            super().connection_lost(exc)

        def _expect_headers(self) -> None:
            self._headers_due = self.loop.call_later(limits.header_s, self.transport.abort)

        def _stop(self, name: str) -> None:
            """Stop a timer that may be running."""
            timer: asyncio.TimerHandle | None = getattr(self, name)
            if timer is not None:
                timer.cancel()
                setattr(self, name, None)

    return PatientProtocol
