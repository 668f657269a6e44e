"""The commands that make maps: `map` and `demo`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import tell
from afkb.cli.state import state_of
from afkb_mapping.source_options import options_of

if TYPE_CHECKING:
    from afkb_mapping.run import RunResult
    from afkb_mapping.run_record import Settings

DEMO_WORLD = "world:paper_home"


def map_(
    ctx: typer.Context,
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="Recording: a path or URI; see `afkb plugins`.")
    ],
    out: Annotated[
        Path | None, typer.Option(help="Map folder to write; replaced whole if it is a map.")
    ] = None,
    update: Annotated[
        Path | None,
        typer.Option(metavar="MAP", help="In place of --out: add a later visit to this map."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on where an interrupted run of this stopped.")
    ] = False,
    hours_later: Annotated[
        float | None,
        typer.Option(
            min=0, help="With --update: how long after the last visit; else the stamps tell."
        ),
    ] = None,
    detector: Annotated[
        list[str] | None, typer.Option(help="Use only this detector; repeat for several.")
    ] = None,
    predictor: Annotated[
        list[str] | None, typer.Option(help="Use only this predictor; repeat for several.")
    ] = None,
    mapper: Annotated[str, typer.Option(help="Mapper that builds the map.")] = "affordance",
    rule: Annotated[
        str, typer.Option(help="How predictions grow: log-odds, noisy-or or literal.")
    ] = "log-odds",
    stride: Annotated[int, typer.Option(min=1, help="Use every n-th frame.")] = 1,
    start: Annotated[int, typer.Option(min=0, help="First frame to use.")] = 0,
    stop: Annotated[int | None, typer.Option(min=0, help="Frame to stop before.")] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(help="Option of the source, key=value; repeat for several."),
    ] = None,
    ontology: Annotated[
        list[Path] | None, typer.Option(help="File that extends the ontology; repeatable.")
    ] = None,
    view: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=TARGET]",
            help="Show the map while it is made: rerun, or rerun=FILE.rrd; repeatable.",
        ),
    ] = None,
    store: Annotated[
        str | None,
        typer.Option(metavar="URL", help="Send the map to this SPARQL server; see `afkb store`."),
    ] = None,
    prefix: Annotated[
        str, typer.Option(metavar="NAME", help="With --store: put before the map's name there.")
    ] = "",
    json_: Annotated[bool, typer.Option("--json", help="Print run.json's content.")] = False,
) -> None:
    """Turn a recording into a topological affordance map.

    Example: afkb map my-recording/ --out my-map

    Example: afkb map next-day/ --update my-map
    """
    from afkb.fleet import Keeper
    from afkb.plugins.host import PluginHost
    from afkb_mapping.run_record import Settings

    host = PluginHost(extensions=ontology) if ontology else state_of(ctx).host
    settings = Settings(
        uri=source,
        out=_folder(out, update),
        detectors=tuple(detector or ()),
        predictors=tuple(predictor or ()),
        mapper=mapper,
        rule=rule,
        start=start,
        stop=stop,
        stride=stride,
        options=options_of(option or ()),
        resume=resume,
        update=update is not None,
        hours_later=hours_later,
        view=tuple(view or ()),
    )
    keeper = Keeper.of(store, prefix, tell) if store else None
    result = _run(host, settings)
    if json_:
        typer.echo(json.dumps(result.run, indent=2))
    else:
        _print_summary(settings, result)
    if keeper is not None:
        tell(f"stored in <{keeper.keep(settings.out).graph}>")
    _exit_as_interrupted(result)


def demo(
    ctx: typer.Context,
    out: Annotated[Path, typer.Option(help="Map folder to write.")] = Path("demo-map"),
    json_: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Map the bundled simulated home of the paper's Fig. 2 and print what came of it.

    Example: afkb demo --out demo-map
    """
    from afkb_mapping.demo_table import demo_results
    from afkb_mapping.run_record import Settings

    settings = Settings(uri=DEMO_WORLD, out=out)
    result = _run(state_of(ctx).host, settings)
    rows = demo_results(result.topological_map)
    if json_:
        typer.echo(json.dumps({r.what: r.ours for r in rows}, indent=2))
    else:
        _print_table(
            "The paper's simulated home (Fig. 2)",
            ("", "paper", "here"),
            [(r.what, r.paper, r.ours) for r in rows],
        )
        _print_summary(settings, result)
    _exit_as_interrupted(result)


def _folder(out: Path | None, update: Path | None) -> Path:
    """The map folder to write; one of both options names it."""
    if (out is None) == (update is None):
        raise typer.BadParameter("name a map folder by one of --out and --update")
    folder = out or update
    assert folder is not None
    return folder


def _run(host: object, settings: Settings) -> RunResult:
    from afkb.plugins.host import PluginHost
    from afkb_mapping.progress import shown_progress
    from afkb_mapping.run import make_map

    assert isinstance(host, PluginHost)
    with shown_progress() as progress:
        return make_map(host, settings, progress)


def _print_summary(settings: Settings, result: RunResult) -> None:
    from afkb.flow import NodeKind

    found = result.topological_map
    kinds = [e.kind for e in found.entities]
    run = result.run
    frames = run["frames"]
    assert isinstance(frames, dict)
    _print_table(
        f"Map in {settings.out}",
        ("", ""),
        [
            ("robot places", str(len(found.places))),
            ("things seen", str(kinds.count(NodeKind.OBSERVED))),
            ("things predicted", str(len(kinds) - kinds.count(NodeKind.OBSERVED))),
            (
                "rooms, doorways, bounds",
                f"{len(found.rooms)}, {len(found.doorways)}, {len(found.bounds)}",
            ),
            ("predictions come true", str(len(found.closures))),
            ("frames used, skipped", f"{frames['used']}, {frames['skipped']}"),
            ("frames/s, peak memory", f"{run['frames_per_second']}, {run['peak_memory_mb']} MB"),
        ],
    )
    for skipped in frames["reasons"][:3]:
        typer.echo(f"skipped {skipped['where']}: {skipped['why']}", err=True)
    if frames["skipped"] > 3:
        typer.echo(f"… {frames['skipped']} skipped in all; run.json lists why", err=True)
    for note in found.notes:
        typer.echo(f"note: {note}", err=True)
    typer.echo(f"look at {settings.out / 'report.html'}")


def _print_table(title: str, header: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(title=title, title_justify="left", show_header=any(header))
    for name in header:
        table.add_column(name)
    for row in rows:
        table.add_row(*row)
    Console().print(table)


def _exit_as_interrupted(result: RunResult) -> None:
    """Leave as a program does that a signal ended: 128 + its number."""
    if result.interrupted is not None:
        typer.echo("stopped early; the map holds what was seen until then", err=True)
        raise typer.Exit(128 + result.interrupted)
