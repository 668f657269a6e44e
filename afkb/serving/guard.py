"""What every request passes before anything looks at it: whose it is, and how it is answered."""

from __future__ import annotations

import ipaddress
from collections.abc import Callable, Collection

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

SECURITY = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
}
"""Headers of every answer: a page of ours loads nothing from elsewhere and nobody frames it."""
_LOCAL = ("localhost", "localhost.localdomain")


class Guard:
    """Refuses what a foreign web page talks a browser into, and signs every answer.

    - The Host must be an address, `localhost` or one of `hosts`: a foreign name that was pointed at
      this machine (DNS rebinding) is refused.
    - A browser's request from another site is refused, unless its Origin is one of `origins`.
    """

    def __init__(
        self,
        app: ASGIApp,
        hosts: Collection[str],
        origins: Collection[str],
        version: Callable[[], str],
    ) -> None:
        self._app = app
        self._hosts = {host.lower() for host in (*hosts, *_LOCAL)}
        self._origins = origins
        self._version = version

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it with 403."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def signed(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in SECURITY.items():
                    headers[name] = value
                if not self._origins:
                    headers["Cross-Origin-Resource-Policy"] = "same-origin"
                headers.setdefault("Cache-Control", "no-cache")
                headers["X-AFKB-Maps"] = self._version()
            await send(message)

        if (problem := self._problem(Headers(scope=scope))) is not None:
            await JSONResponse({"error": problem}, 403)(scope, receive, signed)
            return
        await self._app(scope, receive, signed)

    def _problem(self, headers: Headers) -> str | None:
        host = _name(headers.get("host", ""))
        if not (host in self._hosts or _is_address(host)):
            return f"this server is not called {host[:100]!r}; start it with --name to allow that"
        origin = headers.get("origin")
        foreign = headers.get("sec-fetch-site") in ("cross-site", "same-site")
        visited = headers.get("sec-fetch-mode") == "navigate"
        if foreign and not visited and origin not in self._origins and "*" not in self._origins:
            return "asked by a page of another site; start the server with --cors to allow it"
        return None


def _name(host: str) -> str:
    """A Host header without its port."""
    if host.startswith("["):
        return host[1:].partition("]")[0].lower()
    return host.partition(":")[0].lower().removesuffix(".")


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True
