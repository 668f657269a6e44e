"""`afkb query`: SPARQL over maps and the ontology, or over a server's maps."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text, tell
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb.store.named import NamedQuery
    from afkb.store.results import QueryResult
    from afkb.store.sparql import Dataset


class Format(StrEnum):
    """How an answer is written."""

    TABLE = "table"
    CSV = "csv"
    TSV = "tsv"
    JSON = "json"
    XML = "xml"
    TTL = "ttl"
    NT = "nt"


@dataclass(frozen=True, slots=True)
class _Asked:
    """A query, from the library with values for its parameters or as text, and what to ask."""

    maps: list[Path]
    text: str | None
    named: NamedQuery | None
    values: dict[str, str]

    @property
    def sparql(self) -> str:
        return self.text or (self.named.filled(self.values) if self.named else "")


def query(
    ctx: typer.Context,
    arguments: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[MAP] [QUERY] [NAME=VALUE]...",
            help="The map, unless --map or --endpoint is given, and the query, unless --file does: "
            "SPARQL, or @NAME for one of the library (--list), with values for its parameters.",
            show_default=False,
        ),
    ] = None,
    maps: Annotated[
        list[Path] | None,
        typer.Option("--map", metavar="MAP", help="A map to ask; may be given several times."),
    ] = None,
    endpoint: Annotated[
        str | None,
        typer.Option("--endpoint", metavar="URL", help="Ask this SPARQL 1.1 server instead."),
    ] = None,
    graphs: Annotated[
        list[str] | None,
        typer.Option(
            "--graph", metavar="IRI", help="Ask this graph alone, or a map's by name; repeatable."
        ),
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
    timeout: Annotated[
        float | None,
        typer.Option(
            "--timeout", metavar="S", min=0.001, help="Give up after so long (a server: 60 s)."
        ),
    ] = None,
    list_named: Annotated[
        bool, typer.Option("--list", help="List the queries of the library.")
    ] = False,
) -> None:
    """Ask maps and the ontology in SPARQL 1.1; prefixes (afn:, geo:, prov:, …) are declared.

    Example: afkb query kitchen 'SELECT ?n WHERE { ?n afn:affords afn:ContainAbility }'

    Example: afkb query kitchen @things-by-category category=Chair

    Example: afkb query --map visit1 --map visit2 @room-beliefs --format csv

    Example: afkb query --endpoint http://localhost:7878 --graph home @doorways
    """
    if list_named:
        _print_library(as_json)
        return
    asked = _asked(arguments or [], maps or [], file, endpoint)
    named_graphs = [_graph(name) for name in graphs or []]
    if endpoint is not None:
        from afkb.store.sparql_remote import WAIT_S, query_endpoint

        endpoint = _asked_at(endpoint)
        answer = query_endpoint(endpoint, asked.sparql, named_graphs, (), timeout or WAIT_S)
    else:
        ontology = [*state_of(ctx).host.knowledge_base.files, *(extensions or [])]
        answer = _answer(asked, ontology, named_graphs, timeout)
    form = Format.JSON if as_json else form
    if form is Format.TABLE:
        print_table(answer.columns, answer.cells())
    else:
        print_text(answer.text(form.value))


def _graph(name: str) -> str:
    """The IRI of a graph: as it stands, or that of the map of this name."""
    from afkb.store.vocabulary import map_graph

    return name if name.startswith("urn:") or "://" in name else map_graph(name)


def _asked_at(url: str) -> str:
    """Where a server takes queries, which is found by asking if only its address is given."""
    from urllib.parse import urlsplit

    if urlsplit(url).path.strip("/"):
        return url
    from afkb.fleet import Server
    from afkb.store.http import Address

    found = Server.find(url, patience_s=0.0, to_write=False).query_at.url
    return url.rstrip("/") + found.removeprefix(Address.read(url).url.rstrip("/"))


def _answer(
    asked: _Asked, ontology: list[Path], graphs: list[str], timeout: float | None
) -> QueryResult:
    from afkb.store import Dataset, load
    from afkb.store.limited import within
    from afkb.store.named import check_known
    from afkb.store.sparql import prefixes_for
    from afkb.store.sparql_text import check_syntax, refuse_writing

    sparql = asked.sparql
    refuse_writing(sparql)
    stored = [load(folder) for folder in asked.maps]
    check_syntax(sparql, prefixes_for(stored))
    everything = Dataset.load(stored, ontology)
    if asked.named:
        check_known(everything.store, asked.named, asked.values, everything.prefixes["scene"])
    found = within(timeout, lambda: everything.ask(sparql, graphs))
    if not found.rows and found.truth is None:
        _tell_unknown(everything, sparql)
    return found


def _tell_unknown(everything: Dataset, sparql: str) -> None:
    """Say which names of a query that found nothing are nobody's: a slip is likelier than none."""
    from afkb.store.named import unknown_names

    for name, near in unknown_names(everything.store, sparql):
        hint = f"; near it: {', '.join(near)}" if near else ""
        tell(f"note: nothing is called {name}{hint}")


def _print_library(as_json: bool) -> None:
    from afkb.store.named import named_queries

    found = named_queries()
    if as_json:
        print_json([q.as_json() for q in found])
        return
    rows = [
        (f"@{q.name}", " ".join(f"{p.name}={p.default}" for p in q.parameters), q.about)
        for q in found
    ]
    print_table(["name", "parameters", "answers"], rows)


def _asked(
    arguments: list[str], maps: list[Path], file: Path | None, endpoint: str | None
) -> _Asked:
    """The maps and the query; wrong usage where one is missing or there is more."""
    rest = list(arguments)
    if maps and endpoint is not None:
        raise typer.BadParameter("--map or --endpoint: one of them")
    if not maps and endpoint is None:
        if not rest:
            raise typer.BadParameter("which map? afkb query MAP 'SELECT …'")
        maps = [Path(rest.pop(0))]
    if file is None and not rest:
        raise typer.BadParameter("no query; give one as an argument, or with --file, or @NAME")
    if file is None and rest[0].startswith("@"):
        from afkb.store.named import named_query, read_values

        return _Asked(maps, None, named_query(rest[0]), read_values(rest[1:]))
    if len(rest) > (file is None):
        raise typer.BadParameter(f"one query is enough; what is {rest[-1]!r}?")
    return _Asked(maps, _read_query(file) if file is not None else rest[0], None, {})


def _read_query(file: Path) -> str:
    from afkb.errors import QueryError

    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise QueryError(f"{file}: can't be read as a query ({error})") from error
