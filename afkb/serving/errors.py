"""What a request is refused with: a status and one line."""

from __future__ import annotations

from collections.abc import Mapping

from afkb.errors import AfkbError


class ServingError(AfkbError):
    """A server that can't be started or kept: its port, its host, its processes."""


class Refused(Exception):
    """A request that is not answered; `status` is HTTP's, `message` one line for the client."""

    def __init__(self, status: int, message: str, headers: Mapping[str, str] | None = None) -> None:
        super().__init__(message)
        self.status = status
        self.message = message
        self.headers = dict(headers or {})


def busy(retry_s: int = 1) -> Refused:
    """Too much to do at the moment; the client is told when to come again."""
    after = {"Retry-After": str(retry_s)}
    return Refused(503, f"busy with other queries; ask again in {retry_s} s", after)
