"""`afkb query`: SPARQL over maps and the ontology."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.state import state_of


class Format(StrEnum):
    """How an answer is written."""

    TABLE = "table"
    CSV = "csv"
    JSON = "json"
    TTL = "ttl"


def query(
    ctx: typer.Context,
    arguments: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[MAP] [QUERY]",
            help="The map, unless --map names it, and the query, unless --file does: SPARQL, or "
            "@NAME for one of the library (--list).",
            show_default=False,
        ),
    ] = None,
    maps: Annotated[
        list[Path] | None,
        typer.Option("--map", metavar="MAP", help="A map to ask; may be given several times."),
    ] = None,
    file: Annotated[
        Path | None, typer.Option("--file", metavar="FILE", help="Read the query from a file.")
    ] = None,
    form: Annotated[Format, typer.Option("--format", help="How to print.")] = Format.TABLE,
    as_json: Annotated[bool, typer.Option("--json", help="Same as --format json.")] = False,
    extensions: Annotated[
        list[Path] | None,
        typer.Option(
            "--ontology", metavar="FILE", help="An extension to ask along; may be repeated."
        ),
    ] = None,
    list_named: Annotated[
        bool, typer.Option("--list", help="List the queries of the library.")
    ] = False,
) -> None:
    """Ask maps and the ontology in SPARQL 1.1; prefixes (afn:, geo:, prov:, …) are declared.

    Example: afkb query kitchen 'SELECT ?n WHERE { ?n afn:affords afn:ContainAbility }'

    Example: afkb query --map visit1 --map visit2 @room-beliefs --format csv
    """
    if list_named:
        _print_library(as_json)
        return
    folders, sparql = _asked(arguments or [], maps or [], file)
    from afkb.store import load
    from afkb.store import query as ask

    stored = [load(folder) for folder in folders]
    ontology = state_of(ctx).host.knowledge_base.files
    answer = ask(stored, sparql, [*ontology, *(extensions or [])])
    form = Format.JSON if as_json else form
    if form is Format.TABLE:
        print_table(answer.columns, answer.cells())
    else:
        print_text(answer.text(form.value))


def _print_library(as_json: bool) -> None:
    from afkb.store.named import named_queries

    found = named_queries()
    if as_json:
        print_json([{"name": q.name, "about": q.about, "sparql": q.sparql} for q in found])
    else:
        print_table(["name", "answers"], [(f"@{q.name}", q.about) for q in found])


def _asked(arguments: list[str], maps: list[Path], file: Path | None) -> tuple[list[Path], str]:
    """The maps and the query; wrong usage where one is missing or there is more."""
    rest = list(arguments)
    if not maps:
        if not rest:
            raise typer.BadParameter("which map? afkb query MAP 'SELECT …'")
        maps = [Path(rest.pop(0))]
    if file is None and not rest:
        raise typer.BadParameter("no query; give one as an argument, or with --file, or @NAME")
    if len(rest) > (file is None):
        raise typer.BadParameter(f"one query is enough; what is {rest[-1]!r}?")
    if file is not None:
        return maps, _read_query(file)
    if rest[0].startswith("@"):
        from afkb.store.named import named_query

        return maps, named_query(rest[0]).sparql
    return maps, rest[0]


def _read_query(file: Path) -> str:
    from afkb.errors import QueryError

    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise QueryError(f"{file}: can't be read as a query ({error})") from error
