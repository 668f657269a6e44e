"""One request to a SPARQL server: who asks, what came back, and in one line what went wrong."""

from __future__ import annotations

import base64
import os
import re
import socket
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from email.message import Message
from http.client import HTTPException, HTTPResponse, InvalidURL
from typing import IO
from urllib.error import HTTPError, URLError
from urllib.parse import unquote, urlsplit, urlunsplit
from urllib.request import HTTPRedirectHandler, ProxyHandler, Request, build_opener

from afkb import __version__
from afkb.errors import EndpointError

LONGEST_TOLD = 200
"""Characters of a server's own words that an error repeats."""

_PASSING = frozenset({429, 502, 503, 504})
_LOOPBACK = frozenset({"localhost", "127.0.0.1", "::1"})


class PassingTrouble(EndpointError):
    """Something that may be over soon: nobody listens, the line broke, or the server is busy.

    `wait_s`: what the server asks to wait (Retry-After), or None.
    """

    wait_s: float | None = None


class Refusal(EndpointError):
    """The server understood and says no; `status` is HTTP's."""

    status: int = 0


@dataclass(frozen=True, slots=True)
class Address:
    """Where a server is and who asks; whatever shows it shows no credentials.

    `url`: without user and password. `authorization`: the header's value, or None.
    """

    url: str
    authorization: str | None = field(default=None, repr=False)

    @classmethod
    def read(cls, url: str, environment: Mapping[str, str] = os.environ) -> Address:
        """The address in a URL, with credentials from it or else from the environment.

        `https://user:password@host/…`, or AFKB_STORE_USER and AFKB_STORE_PASSWORD, or
        AFKB_STORE_TOKEN (a bearer token). `EndpointError` where it is no http(s) URL.
        """
        try:
            parts = urlsplit(url)
            host, port = parts.hostname, parts.port
        except ValueError:
            # The URL itself may hold a password: it is not repeated.
            raise EndpointError(
                "the server's URL can't be read; percent-encode what is unusual in its user and "
                "password"
            ) from None
        if parts.scheme not in ("http", "https") or not host:
            raise EndpointError(
                f"{parts.scheme or 'that'}://…: not the URL of a server; "
                "write it as http://localhost:7878 or https://host/path"
            )
        at = f"[{host}]" if ":" in host else host
        place = at if port is None else f"{at}:{port}"
        plain = urlunsplit((parts.scheme, place, parts.path.rstrip("/"), parts.query, ""))
        return cls(plain, _authorization(parts.username, parts.password, environment))

    @property
    def is_loopback(self) -> bool:
        """Whether the server is on this machine."""
        return urlsplit(self.url).hostname in _LOOPBACK

    @property
    def shows_credentials(self) -> bool:
        """Whether credentials would go over a network in plain text."""
        plain = self.url.startswith("http:") and not self.is_loopback
        return plain and self.authorization is not None

    def at(self, url: str) -> Address:
        """Another URL, for the same person."""
        return Address(url, self.authorization)


@dataclass(frozen=True, slots=True)
class Reply:
    """What came back: the media type without its parameters, and the content."""

    media_type: str
    body: bytes


def post(
    address: Address, body: bytes, content_type: str, accept: str = "*/*", timeout_s: float = 60.0
) -> Reply:
    """The answer to one POST; no redirect is followed, so credentials go nowhere else.

    Raises `PassingTrouble` where asking again may help; `Refusal`, or for an unknown host
    `EndpointError`, where it won't.
    """
    headers = {
        "Content-Type": content_type,
        "Accept": accept,
        "User-Agent": f"afkb/{__version__}",
    }
    if address.authorization:
        headers["Authorization"] = address.authorization
    request = Request(address.url, data=body, headers=headers, method="POST")
    around = [ProxyHandler({})] if address.is_loopback else []
    try:
        with build_opener(_Stay, *around).open(request, timeout=timeout_s) as answer:
            return Reply(answer.headers.get_content_type(), _whole(answer, timeout_s))
    except HTTPError as error:
        with error:
            raise _refused(address, error) from None
    except (ValueError, InvalidURL):
        told = f"{address.url!a}: not a URL that HTTP can carry; percent-encode what is unusual"
        raise EndpointError(told) from None
    except (URLError, OSError, HTTPException) as error:
        raise _unreachable(address, error, timeout_s) from None


def _whole(answer: HTTPResponse, timeout_s: float) -> bytes:
    """The body; `TimeoutError` where it has not come whole in time, however steadily it drips."""
    until = time.monotonic() + timeout_s
    parts = []
    while part := answer.read1(1 << 16):
        parts.append(part)
        if time.monotonic() > until:
            raise TimeoutError
    return b"".join(parts)


def _header_word(token: str) -> str:
    """A token without the line break that files of secrets end in; `EndpointError` for no token."""
    word = token.strip()
    if not word.isascii() or not word.isprintable():
        raise EndpointError("AFKB_STORE_TOKEN: no header can carry that; is it the token alone?")
    return word


class _Stay(HTTPRedirectHandler):
    def redirect_request(
        self, req: Request, fp: IO[bytes], code: int, msg: str, headers: Message, newurl: str
    ) -> None:
        """No other request: the redirect is told as an error."""


def _authorization(
    user: str | None, password: str | None, environment: Mapping[str, str]
) -> str | None:
    if user is None:
        if token := environment.get("AFKB_STORE_TOKEN"):
            return f"Bearer {_header_word(token)}"
        user, password = environment.get("AFKB_STORE_USER"), environment.get("AFKB_STORE_PASSWORD")
        if not user:
            return None
    else:
        user, password = unquote(user), unquote(password or "")
    return "Basic " + base64.b64encode(f"{user}:{password or ''}".encode()).decode()


def _refused(address: Address, error: HTTPError) -> EndpointError:
    told = _said(error)
    if error.code in _PASSING:
        passing = PassingTrouble(f"{address.url}: is busy ({error.code} {error.reason}){told}")
        wait = error.headers.get("Retry-After", "")
        passing.wait_s = float(wait) if wait.isdigit() else None
        return passing
    mend = ""
    if error.code in (401, 403):
        mend = "; name who asks by AFKB_STORE_USER and AFKB_STORE_PASSWORD, or AFKB_STORE_TOKEN"
    elif 300 <= error.code < 400:
        mend = f"; it points to {_plain(error.headers.get('Location', '?'))}: use that URL"
    refusal = Refusal(f"{address.url}: {error.code} {error.reason}{told}{mend}")
    refusal.status = error.code
    return refusal


def _plain(url: str) -> str:
    """A URL that a server names, without what may be secret in it."""
    return re.sub(r"//[^/@]*@", "//", url).partition("?")[0][:LONGEST_TOLD]


def _said(error: HTTPError) -> str:
    """The server's own words in one line, shortened; nothing where it said nothing."""
    try:
        text = error.read(16 * LONGEST_TOLD).decode("utf-8", "replace")
    except (OSError, HTTPException):
        return ""
    words = " ".join(re.sub(r"<[^>]{0,500}>", " ", text).split())
    short = words if len(words) <= LONGEST_TOLD else words[:LONGEST_TOLD] + "…"
    return f": {short}" if short else ""


def _unreachable(address: Address, error: Exception, timeout_s: float) -> EndpointError:
    reason = error.reason if isinstance(error, URLError) else error
    if isinstance(reason, TimeoutError):
        why = f"no answer within {timeout_s:g} s"
    elif isinstance(reason, ConnectionRefusedError):
        why = "nobody listens there; is the server running?"
    elif isinstance(reason, socket.gaierror) and reason.errno == socket.EAI_NONAME:
        return EndpointError(f"{address.url}: no such host; is the URL spelt right?")
    elif isinstance(reason, socket.gaierror):
        why = "its host's address can't be looked up now"
    else:
        why = f"the connection failed ({str(reason) or type(reason).__name__})"
    return PassingTrouble(f"{address.url}: {why}")
