"""SPARQL 1.1 Protocol: from an HTTP request to the query that it asks, or why it is refused.

https://www.w3.org/TR/sparql11-protocol/, section 2.1 (queries) and 2.2 (updates, refused).
"""

from __future__ import annotations

import asyncio
from urllib.parse import parse_qs

from starlette.requests import Request

from afkb.serving.errors import Refused
from afkb.serving.forms import Question
from afkb.serving.limits import Limits

QUERY = "application/sparql-query"
UPDATE = "application/sparql-update"
FORM = "application/x-www-form-urlencoded"
_MOST_FIELDS = 100
_DISCARDED = 16
"""So many times the limit is read of a request that is too large, so that its sender hears why."""
_READ_ONLY = "these maps are read-only: ask with SELECT, ASK, CONSTRUCT or DESCRIBE"


async def question_of(request: Request, limits: Limits) -> Question | None:
    """What is asked; None for a GET that asks nothing, which is a wish for the description."""
    given = _fields(request.scope["query_string"])
    if request.method != "POST":
        if not given:
            return None
        return _question(given, request)
    media = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media == UPDATE:
        raise Refused(403, _READ_ONLY)
    if media not in (QUERY, FORM):
        raise Refused(415, f"a query is posted as {QUERY} or {FORM}, not as {media or 'nothing'}")
    body = await read_body(request, limits)
    if media == QUERY:
        if "query" in given:
            raise Refused(400, "the query is given twice, in the address and in the body")
        return _question({**given, "query": [_text(body)]}, request)
    return _question(_joined(given, _fields(body)), request)


async def read_body(request: Request, limits: Limits) -> bytes:
    """The body, within the limits of size and time."""
    most = limits.request_kb * 1024
    too_large = Refused(413, f"a request may have {limits.request_kb} kB; ask with a shorter one")
    parts: list[bytes] = []
    length = 0
    try:
        async with asyncio.timeout(limits.upload_s):
            async for part in request.stream():
                length += len(part)
                if length > most * _DISCARDED:
                    raise too_large
                if length <= most:
                    parts.append(part)
    except TimeoutError:
        raise Refused(408, f"the request did not come whole in {limits.upload_s:g} s") from None
    if length > most:
        raise too_large
    return b"".join(parts)


def _fields(encoded: bytes) -> dict[str, list[str]]:
    try:
        return parse_qs(
            encoded.decode("ascii"),
            keep_blank_values=True,
            errors="strict",
            max_num_fields=_MOST_FIELDS,
        )
    except (UnicodeDecodeError, ValueError):
        raise Refused(
            400, f"parameters must be percent-encoded UTF-8, and no more than {_MOST_FIELDS}"
        ) from None


def _joined(one: dict[str, list[str]], other: dict[str, list[str]]) -> dict[str, list[str]]:
    return {key: [*one.get(key, []), *other.get(key, [])] for key in {**one, **other}}


def _question(given: dict[str, list[str]], request: Request) -> Question:
    if "update" in given or "using-graph-uri" in given or "using-named-graph-uri" in given:
        raise Refused(403, _READ_ONLY)
    asked = given.get("query", [])
    if len(asked) != 1:
        what = "there is no query parameter" if not asked else "there are several queries"
        raise Refused(400, f"{what}; ask with ?query=SELECT…, or POST it as {QUERY}")
    return Question(
        asked[0],
        tuple(given.get("default-graph-uri", ())),
        tuple(given.get("named-graph-uri", ())),
        request.headers.get("accept", ""),
    )


def _text(body: bytes) -> str:
    try:
        return body.decode("utf-8")
    except UnicodeDecodeError as error:
        raise Refused(400, f"the query is not UTF-8 (byte {error.start})") from None
