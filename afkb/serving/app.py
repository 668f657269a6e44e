"""The addresses of the server, and what stands before them."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.cors import CORSMiddleware
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.routing import Route

from afkb.serving.endpoint import METHODS, Endpoint
from afkb.serving.errors import Refused
from afkb.serving.guard import Guard
from afkb.serving.pages import Pages
from afkb.serving.sending import Outgoing
from afkb.serving.served import Served


def build_app(
    served: Served, hosts: Collection[str] = (), origins: Collection[str] = ()
) -> Starlette:
    """The application over what is served; see `Guard` for hosts and origins."""
    outgoing = Outgoing(served.limits)
    pages = Pages(served, outgoing)
    routes = [
        Route("/", pages.page),
        Route("/static/{name}", pages.static),
        Route("/sparql", Endpoint(served, outgoing).sparql, methods=METHODS),
        Route("/api/maps", pages.maps),
        Route("/api/maps/{name}/plan", pages.plan),
        Route("/api/maps/{name}/history", pages.history),
        Route("/api/maps/{name}/why/{node}", pages.why),
        Route("/api/queries", pages.queries),
    ]
    return Starlette(
        routes=routes,
        middleware=_before_all(served, hosts, origins),
        exception_handlers={Refused: _refused, HTTPException: _not_there, Exception: _failed},
    )


def _before_all(
    served: Served, hosts: Collection[str], origins: Collection[str]
) -> list[Middleware]:
    guard = Middleware(Guard, hosts, origins, lambda: served.now.version)
    if not origins:
        return [guard]
    settings: dict[str, Any] = {
        "allow_origins": list(origins),
        "allow_methods": ["GET", "HEAD", "POST"],
        "allow_headers": ["Accept", "Content-Type"],
        "expose_headers": ["Retry-After", "X-AFKB-Maps"],
    }
    return [guard, Middleware(CORSMiddleware, **settings)]


def _refused(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, Refused)
    return JSONResponse({"error": error.message}, error.status, error.headers)


def _not_there(request: Request, error: Exception) -> JSONResponse:
    """An address that there is not, or a method that it does not take."""
    assert isinstance(error, HTTPException)
    told = {404: "no such address", 405: f"{request.method} is not for this address"}
    message = told.get(error.status_code, error.detail)
    return JSONResponse({"error": message}, error.status_code, error.headers)


def _failed(_: Request, __: Exception) -> JSONResponse:
    return JSONResponse({"error": "the server failed at this; its log says how"}, 500)
