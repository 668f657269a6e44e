"""`afkb store`: maps kept by a SPARQL 1.1 server, a named graph each."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text, tell
from afkb.cli.scene_commands import JsonOption

if TYPE_CHECKING:
    from afkb.fleet import Server

PATIENCE_S = 60.0
UrlOption = Annotated[
    str | None,
    typer.Option("--url", metavar="URL", help="Of a SPARQL 1.1 server; else AFKB_STORE names it."),
]
UpdateUrlOption = Annotated[
    str | None,
    typer.Option(metavar="URL", help="Where it takes updates, if that is not found by asking."),
]
PatienceOption = Annotated[
    float, typer.Option(min=0, metavar="SECONDS", help="How long it may be away.")
]

app = typer.Typer(
    no_args_is_help=True,
    help="Keep maps in a SPARQL 1.1 server, a named graph each.\n\n"
    "Example: afkb store push kitchen --url http://localhost:7878",
)


@app.command()
def push(
    maps: Annotated[list[Path], typer.Argument(metavar="MAP...", help="Map folders.")],
    url: UrlOption = None,
    name: Annotated[
        str | None, typer.Option("--as", metavar="NAME", help="In place of the folder's name.")
    ] = None,
    prefix: Annotated[
        str, typer.Option(metavar="NAME", help="Put before each name, as the site or the robot.")
    ] = "",
    update_url: UpdateUrlOption = None,
    patience: PatienceOption = PATIENCE_S,
    as_json: JsonOption = False,
) -> None:
    """Send maps to a server; one of the same name is replaced in one step.

    Run again after whatever went wrong: it goes on where it stopped.

    Example: afkb store push kitchen hall --url http://localhost:7878

    Example: afkb store push maps/* --prefix north --url https://maps.example/sparql
    """
    from afkb.fleet import named, push
    from afkb.store import load

    chosen = named(maps, name, prefix)
    loaded = {name: load(folder) for name, folder in chosen.items()}
    server = reached(url, update_url, patience)
    kept = [push(server, stored, name) for name, stored in loaded.items()]
    if as_json:
        rows = [(k.name, k.graph, k.triples, k.state.value) for k in kept]
        print_json([dict(zip(("name", "graph", "triples", "state"), r, strict=True)) for r in rows])
    else:
        for k in kept:
            print_text(f"{k.name}: {k.state.value}, {k.triples} statements in <{k.graph}>")


@app.command(name="list")
def list_(
    url: UrlOption = None, patience: PatienceOption = 0.0, as_json: JsonOption = False
) -> None:
    """List the maps that a server keeps.

    Example: afkb store list --url http://localhost:7878
    """
    from dataclasses import asdict

    from afkb.fleet import kept_maps

    found = kept_maps(reached(url, None, patience, to_write=False))
    if as_json:
        print_json([asdict(kept) for kept in found])
    else:
        rows = [(k.name, k.triples, k.since, k.graph) for k in found]
        print_table(["name", "statements", "since", "graph"], rows, numbers=["statements"])


@app.command()
def remove(
    name: Annotated[str, typer.Argument(metavar="NAME", help="As `afkb store list` shows it.")],
    url: UrlOption = None,
    update_url: UpdateUrlOption = None,
    patience: PatienceOption = PATIENCE_S,
) -> None:
    """Take a map out of a server.

    Example: afkb store remove kitchen --url http://localhost:7878
    """
    from afkb.fleet import remove

    gone = remove(reached(url, update_url, patience), name)
    print_text(f"{gone.name}: removed, {gone.triples} statements of <{gone.graph}>")


def reached(
    url: str | None, update_url: str | None, patience_s: float, to_write: bool = True
) -> Server:
    """The server at a URL, or at the one that AFKB_STORE names."""
    from afkb.fleet import Server

    url = url or os.environ.get("AFKB_STORE")
    if not url:
        raise typer.BadParameter("which server? name it by --url, or AFKB_STORE")
    return Server.find(url, update_url, patience_s, tell, to_write)
