"""`/sparql`: the endpoint of the SPARQL 1.1 Protocol."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import Response

from afkb.serving.description import description
from afkb.serving.errors import Refused
from afkb.serving.forms import GRAPHS
from afkb.serving.negotiation import preferred
from afkb.serving.protocol import FORM, QUERY, question_of
from afkb.serving.sending import Outgoing, while_connected
from afkb.serving.served import Served

METHODS = ("GET", "HEAD", "POST", "OPTIONS")


class Endpoint:
    """Answers queries over all maps that are served."""

    def __init__(self, served: Served, outgoing: Outgoing) -> None:
        self._served = served
        self._outgoing = outgoing

    async def sparql(self, request: Request) -> Response:
        """The answer to a query, or of a GET without one the endpoint's description."""
        if request.method == "OPTIONS":
            headers = {"Allow": ", ".join(METHODS), "Accept-Post": f"{QUERY}, {FORM}"}
            return Response(status_code=204, headers=headers)
        question = await question_of(request, self._served.limits)
        if question is None:
            return self._description(request)
        head = {
            "default": question.default_graphs,
            "named": question.named_graphs,
            "accept": question.accept,
        }
        # A lone surrogate, which percent-encoding can't bring but a test might, is no UTF-8.
        body = question.sparql.encode("utf-8", "replace")
        asking = self._served.now.asking.ask(head, body)
        return self._outgoing.response(*await while_connected(request, asking))

    def _description(self, request: Request) -> Response:
        media = preferred(request.headers.get("accept", ""), tuple(GRAPHS))
        if media is None and "text/html" not in request.headers.get("accept", ""):
            raise Refused(406, f"the description comes as {', '.join(GRAPHS)}")
        media = media or "text/turtle"
        endpoint = str(request.url.replace(query="", fragment=""))
        told = description(endpoint, self._served.now.graphs, media)
        return Response(told, media_type=media, headers={"Vary": "Accept"})
