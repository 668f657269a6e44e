"""`afkb ontology count`: counts rooms and what is in them, for figures from real homes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, tell
from afkb.figures.reading import Shape

if TYPE_CHECKING:
    from afkb.figures.counting import Unknown
    from afkb.figures.counts import Counts

_UNKNOWN_SHOWN = 12


def count(
    rooms: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Tables of rooms.")],
    out: Annotated[Path, typer.Option(help="Folder to write the counts into.")],
    shape: Annotated[
        Shape, typer.Option(help="Columns of the tables; auto tells by the header.")
    ] = Shape.AUTO,
    simulated: Annotated[
        Path | None, typer.Option(help="Folder of tables of BDDL, ProcTHOR and VirtualHome.")
    ] = None,
    tables: Annotated[
        Path | None,
        typer.Option(help="Folder of tables.  [default: beside the bundled ontology]"),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Count rooms, the things in them and what stands together, building by building.

    Homes of your own are a CSV with the columns building,room,category,objects, as in
    `my-flat,r1,kitchen,mug:4|kitchen table:1`. Any name is understood that the ontology or one of
    its sources has; the others are counted and told. The same tables give the same bytes.

    Example: afkb ontology count my-homes.csv --out my-counts
    """
    from afkb.figures import Names, count_rooms, read_simulated, write_counts
    from afkb.ontology.bundled import bundled_ontology

    names = Names.load(tables or bundled_ontology().parent / "tables")
    counts, unknown = count_rooms(rooms, names, shape)
    if simulated is not None:
        pooled, not_understood = read_simulated(simulated, names)
        counts = counts.plus(pooled)
        unknown.things.update(not_understood.things)
        unknown.rooms.update(not_understood.rooms)
    write_counts(counts, out)
    _show(counts, unknown, as_json)
    tell(f"{out}: counts of {len(counts.sources)} sources")


def _show(counts: Counts, unknown: Unknown, as_json: bool) -> None:
    rows = [_summary(counts, source) for source in sorted(counts.sources)]
    if as_json:
        names = {"things": _plain(unknown.things), "rooms": _plain(unknown.rooms)}
        print_json({"sources": rows, "unknown_names": names})
        return
    print_table(list(rows[0]), [list(row.values()) for row in rows], numbers=list(rows[0])[1:])
    for what, by_source in (("things", unknown.things), ("rooms", unknown.rooms)):
        for source, met in by_source.items():
            shown = ", ".join(f"{n} ({c})" for n, c in _ordered(met)[:_UNKNOWN_SHOWN])
            tell(f"{source}: {len(met)} names of {what} not understood; the commonest: {shown}")


def _summary(counts: Counts, source: str) -> dict[str, object]:
    buildings = [b for (name, _), b in counts.buildings.items() if name == source]
    tallies = [tally for building in buildings for tally in building.rooms.values()]
    placed = [s for (name, _), s in counts.supports.items() if name == source]
    left_out = dict(counts.sources[source].left_out)
    return {
        "source": source,
        "buildings": sum(1 for name, building in counts.buildings if name == source and building),
        "rooms": sum(tally.rooms for tally in tallies),
        "rooms left out": sum(n for what, n in left_out.items() if what.startswith("rooms")),
        "categories": len(counts.sources[source].categories),
        "things": sum(sum(tally.things.values()) for tally in tallies),
        "placements": sum(sum(supports.values()) for supports in placed),
        "things left out": left_out.get("things of unknown name", 0),
    }


def _ordered(met: Counter[str]) -> list[tuple[str, int]]:
    return sorted(met.items(), key=lambda item: (-item[1], item[0]))


def _plain(unknown: Mapping[str, Counter[str]]) -> dict[str, dict[str, int]]:
    return {source: dict(_ordered(met)) for source, met in sorted(unknown.items())}
