"""`afkb batch`: many recordings, mapped at once."""

from __future__ import annotations

import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from afkb.cli.errors import INTERRUPTED
from afkb.cli.output import print_json, print_table, tell
from afkb.cli.state import state_of
from afkb_mapping.source_options import options_of

if TYPE_CHECKING:
    from afkb_mapping.batch.job import Outcome


def batch(
    ctx: typer.Context,
    sources: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="SOURCE...",
            help="Recordings: paths, patterns of paths or URIs; NAME=SOURCE names the map.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for the maps, a folder each.")
    ] = Path("maps"),
    list_: Annotated[
        Path | None,
        typer.Option("--list", metavar="FILE", help="Read more recordings from a file's lines."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Recordings mapped at once; else one per core.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS", help="Dask scheduler of a cluster whose workers see the same files."
        ),
    ] = None,
    memory_limit: Annotated[
        str | None,
        typer.Option(metavar="SIZE", help="Memory per recording, 4GB; else an equal share."),
    ] = None,
    time_limit: Annotated[
        float | None,
        typer.Option(min=0, metavar="SECONDS", help="Give a recording up after so long."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Skip what is mapped; go on with what was begun.")
    ] = False,
    store: Annotated[
        str | None,
        typer.Option(metavar="URL", help="Send each map to this SPARQL server; see `afkb store`."),
    ] = None,
    prefix: Annotated[
        str, typer.Option(metavar="NAME", help="With --store: put before each map's name there.")
    ] = "",
    detector: Annotated[
        list[str] | None, typer.Option(help="Use only this detector; repeat for several.")
    ] = None,
    predictor: Annotated[
        list[str] | None, typer.Option(help="Use only this predictor; repeat for several.")
    ] = None,
    mapper: Annotated[str, typer.Option(help="Mapper that builds the maps.")] = "affordance",
    rule: Annotated[str, typer.Option(help="How predictions grow, as of `map`.")] = "log-odds",
    stride: Annotated[int, typer.Option(min=1, help="Use every n-th frame.")] = 1,
    start: Annotated[int, typer.Option(min=0, help="First frame to use.")] = 0,
    stop: Annotated[int | None, typer.Option(min=0, help="Frame to stop before.")] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(help="Option of the sources, key=value; repeat for several."),
    ] = None,
    ontology: Annotated[
        list[Path] | None, typer.Option(help="File that extends the ontology; repeatable.")
    ] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Map many recordings at once, each in a process of its own; one failure stops no other.

    Example: afkb batch homes/*/bag --out maps --workers 4

    Example: afkb batch --list recordings.txt --out maps --resume --store http://localhost:7878
    """
    from afkb.fleet import Keeper
    from afkb_mapping.batch.recordings import recordings
    from afkb_mapping.batch.running import Batch
    from afkb_mapping.run_record import Settings

    named = recordings(sources or [], _lines(list_))
    if not named:
        raise typer.BadParameter("which recordings? afkb batch SOURCE... --out DIR")
    settings = [
        (
            name,
            Settings(
                uri=uri,
                out=(out / name).absolute(),
                detectors=tuple(detector or ()),
                predictors=tuple(predictor or ()),
                mapper=mapper,
                rule=rule,
                start=start,
                stop=stop,
                stride=stride,
                options=options_of(option or ()),
            ),
        )
        for name, uri in named.items()
    ]
    keeper = Keeper.of(store, prefix, tell) if store else None
    whole = Batch(
        settings,
        extensions=tuple(Path(file).absolute() for file in ontology or ()),
        workers=workers,
        scheduler=scheduler,
        memory_limit=_size(memory_limit),
        seconds=time_limit,
        keeper=keeper,
    )
    if not ontology:
        whole.knowledge_base = state_of(ctx).host.knowledge_base
    signal.signal(signal.SIGTERM, _as_interrupted)
    try:
        whole.run(resume)
    except KeyboardInterrupt:
        _print(whole.outcomes, json_)
        tell(f"stopped; {len(named) - len(whole.outcomes)} not mapped: go on with --resume")
        raise typer.Exit(INTERRUPTED) from None
    _print(whole.outcomes, json_)
    if any(found.error for found in whole.outcomes):
        raise typer.Exit(1)


def _as_interrupted(*_: object) -> NoReturn:
    raise KeyboardInterrupt


def _lines(file: Path | None) -> Sequence[str]:
    from afkb.errors import SourceError

    if file is None:
        return ()
    if str(file) == "-":
        return sys.stdin.read().splitlines()
    try:
        return file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise SourceError(f"{file}: can't be read as a list of recordings ({error})") from error


def _size(written: str | None) -> int | None:
    from dask.utils import parse_bytes

    if written is None:
        return None
    try:
        return int(parse_bytes(written))
    except ValueError as error:
        raise typer.BadParameter(f"--memory-limit {written}: write it as 4GB or 800MB") from error


def _print(outcomes: Sequence[Outcome], as_json: bool) -> None:
    in_order = sorted(outcomes, key=lambda found: found.name)
    failed = sum(found.error is not None for found in in_order)
    if as_json:
        print_json({"maps": [found.as_json() for found in in_order], "failed": failed})
        return
    columns = ["map", "what", "frames", "things", "rooms", "MB", "s", "stored in"]
    rows = [
        (f.name, f.state, f.frames, f.things, f.rooms, f.peak_memory_mb, f.seconds, f.stored or "")
        for f in in_order
    ]
    print_table(columns, rows, numbers=["frames", "things", "rooms", "MB", "s"])
    for found in in_order:
        if found.error:
            tell(f"error: {found.name}: {found.error}")
