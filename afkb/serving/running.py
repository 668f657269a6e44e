"""A server from its start to its end."""

from __future__ import annotations

import asyncio
import errno
import signal
import socket
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import uvicorn

from afkb.serving.app import build_app
from afkb.serving.channel import Head
from afkb.serving.errors import ServingError
from afkb.serving.limits import Limits
from afkb.serving.patient import patient_protocol
from afkb.serving.served import Served

_FAREWELL_S = 3
"""So long answers that are under way may take when the server is told to end."""


@dataclass(frozen=True, slots=True)
class Address:
    """Where a server listens, who may ask, and under which names.

    `host`: an address of this machine; `port`: 0 takes any that is free. `names`: host names by
    which it may be asked besides. `origins`: web sites whose pages may ask.
    """

    host: str = "127.0.0.1"
    port: int = 8000
    names: Sequence[str] = ()
    origins: Collection[str] = ()


def serve(
    folders: Sequence[Path],
    ontology: Sequence[Path],
    address: Address,
    limits: Limits,
    ready: Callable[[str, list[Head]], None],
    tell: Callable[[str], None],
) -> None:
    """Serve maps until Ctrl-C or SIGTERM; returns then.

    `ready` is called with the server's URL and its maps once it answers, `tell` with what a person
    should know later on. `MapError` where a map can't be read, `ServingError` where the address
    can't be had.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with _listening(address) as listener:
        try:
            asyncio.run(_serve(listener, folders, ontology, address, limits, ready, tell))
        except KeyboardInterrupt:
            return


async def _serve(
    listener: socket.socket,
    folders: Sequence[Path],
    ontology: Sequence[Path],
    address: Address,
    limits: Limits,
    ready: Callable[[str, list[Head]], None],
    tell: Callable[[str], None],
) -> None:
    served = Served(folders, ontology, limits, tell)
    watching = None
    try:
        await served.open()
        watching = asyncio.create_task(served.watch())
        app = build_app(served, (*address.names, address.host), address.origins)
        server = uvicorn.Server(_config(app, limits))
        ready(_url(listener), served.now.maps)
        await server.serve(sockets=[listener])
    finally:
        if watching is not None:
            watching.cancel()
        served.close()


def _config(app: object, limits: Limits) -> uvicorn.Config:
    return uvicorn.Config(
        app,  # type: ignore[arg-type]
        http=patient_protocol(limits),
        ws="none",
        lifespan="off",
        log_config=None,
        log_level="error",
        access_log=False,
        server_header=False,
        proxy_headers=False,
        timeout_keep_alive=5,
        timeout_graceful_shutdown=_FAREWELL_S,
    )


def _listening(address: Address) -> socket.socket:
    """A socket that listens there; `ServingError` with what to do where that can't be."""
    try:
        family, *_, where = socket.getaddrinfo(
            address.host, address.port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        return socket.create_server(where[:2], family=family, backlog=256)
    except (OSError, OverflowError) as error:
        raise ServingError(_why_not(address, error)) from error


def _why_not(address: Address, error: Exception) -> str:
    number = getattr(error, "errno", None)
    if number == errno.EADDRINUSE:
        return f"port {address.port} is in use; choose another with --port, or --port 0 for any"
    if number == errno.EACCES:
        return f"port {address.port} needs an administrator's rights; choose one above 1023"
    where = f"{address.host}:{address.port}"
    return f"{where}: can't listen there ({error}); --host is an address of this machine"


def _url(listener: socket.socket) -> str:
    host, port = listener.getsockname()[:2]
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"
