"""`afkb serve`: maps as a SPARQL endpoint and a page."""

from __future__ import annotations

import ipaddress
import json
from pathlib import Path
from typing import Annotated, Any

import typer

from afkb.cli.output import print_text, tell
from afkb.cli.state import state_of

_LIMITS = "Limits"


def serve(
    ctx: typer.Context,
    maps: Annotated[list[Path], typer.Argument(metavar="MAP...", help="The maps to serve.")],
    host: Annotated[
        str, typer.Option(help="Address to listen at; any but 127.0.0.1 and ::1 lets others ask.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port to listen at; 0 takes any that is free.", min=0, max=65535)
    ] = 8000,
    names: Annotated[
        list[str] | None,
        typer.Option("--name", help="A host name that the server is asked by; repeatable."),
    ] = None,
    origins: Annotated[
        list[str] | None,
        typer.Option(
            "--cors", metavar="ORIGIN", help="A site whose pages may ask, or *; repeatable."
        ),
    ] = None,
    timeout: Annotated[
        float, typer.Option(help="Seconds a query may take.", min=0.1, rich_help_panel=_LIMITS)
    ] = 10.0,
    memory: Annotated[
        int, typer.Option(help="Memory a query may take, MB.", min=16, rich_help_panel=_LIMITS)
    ] = 512,
    largest: Annotated[
        int,
        typer.Option("--answer", help="Largest answer, MB.", min=1, rich_help_panel=_LIMITS),
    ] = 16,
    workers: Annotated[
        int, typer.Option(help="Queries that run at once.", min=1, rich_help_panel=_LIMITS)
    ] = 2,
    extensions: Annotated[
        list[Path] | None,
        typer.Option("--ontology", metavar="FILE", help="An extension to serve along; repeatable."),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the address as a line of JSON, once it answers.")
    ] = False,
) -> None:
    """Serve maps, read-only: a page at /, SPARQL 1.1 at /sparql; Ctrl-C ends it.

    A map that is written anew meanwhile is served anew.

    Example: afkb serve kitchen office
    """
    from afkb.serving.limits import Limits
    from afkb.serving.running import Address
    from afkb.serving.running import serve as run

    if not _is_loopback(host):
        tell(f"warning: whoever reaches {host} can ask these maps; there is no password")

    def ready(url: str, served: list[dict[str, Any]]) -> None:
        if as_json:
            print_text(json.dumps({"url": url, "sparql": f"{url}sparql", "maps": served}))
        else:
            print_text(f"{', '.join(m['name'] for m in served)} at {url} (Ctrl-C ends)")

    run(
        maps,
        [*state_of(ctx).host.knowledge_base.files, *(extensions or [])],
        Address(host, port, names or (), origins or ()),
        Limits(seconds=timeout, memory_mb=memory, answer_mb=largest, workers=workers),
        ready,
        tell,
    )
    tell("stopped")


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
