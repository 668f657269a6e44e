"""The page, and what it asks for: maps, their drawings, and why a node is there."""

from __future__ import annotations

import json
from dataclasses import asdict

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from afkb.serving.channel import Head
from afkb.serving.errors import Refused
from afkb.serving.sending import Outgoing, while_connected
from afkb.serving.served import Served


class Pages:
    """Answers every address but `/sparql`; each name is looked up, none becomes a path."""

    def __init__(self, served: Served, outgoing: Outgoing) -> None:
        self._served = served
        self._outgoing = outgoing

    async def page(self, request: Request) -> Response:
        """The page itself."""
        return _asset(request, "serve.html")

    async def static(self, request: Request) -> Response:
        """A file that the page needs."""
        return _asset(request, request.path_params["name"])

    async def maps(self, request: Request) -> Response:
        """The maps by name, each with its graph and how many nodes it has."""
        return JSONResponse(self._served.now.maps)

    async def plan(self, request: Request) -> Response:
        """A map's drawing."""
        tag = self._tag(request)
        if _is_known(request, tag):
            return Response(status_code=304, headers={"ETag": tag})
        response = self._outgoing.response(*await self._drawing(request))
        response.headers["ETag"] = tag
        return response

    async def history(self, request: Request) -> Response:
        """When a map's things came, were confirmed, refuted and seen last."""
        head, body = await self._drawing(request)
        if head["status"] == 200:
            body = json.dumps(json.loads(body)["time"]).encode()
        return self._outgoing.response(head, body)

    async def why(self, request: Request) -> Response:
        """What `afkb why MAP NODE --json` tells."""
        telling = self._served.now.tell(self._map(request), request.path_params["node"])
        return self._outgoing.response(*await while_connected(request, telling))

    async def queries(self, request: Request) -> Response:
        """The library of queries."""
        from afkb.store.named import named_queries

        return JSONResponse([asdict(query) for query in named_queries()])

    async def _drawing(self, request: Request) -> tuple[Head, bytes]:
        return await while_connected(request, self._served.now.tell(self._map(request)))

    def _map(self, request: Request) -> str:
        name = str(request.path_params["name"])
        if all(served["name"] != name for served in self._served.now.maps):
            raise Refused(404, f"no map {name[:100]!r} here; /api/maps lists them")
        return name

    def _tag(self, request: Request) -> str:
        number = [served["name"] for served in self._served.now.maps].index(self._map(request))
        return f'"{self._served.now.version}-{number}"'


def _asset(request: Request, name: str) -> Response:
    """A file of the drawing's; only those that it names itself are ever read."""
    import hashlib

    from afkb.drawing import asset

    try:
        content, media = asset(name)
    except KeyError:
        raise Refused(404, f"no file {name[:100]!r} here") from None
    tag = f'"{hashlib.sha256(content).hexdigest()[:16]}"'
    if _is_known(request, tag):
        return Response(status_code=304, headers={"ETag": tag})
    return Response(content, media_type=media, headers={"ETag": tag})


def _is_known(request: Request, tag: str) -> bool:
    return tag in request.headers.get("if-none-match", "")
