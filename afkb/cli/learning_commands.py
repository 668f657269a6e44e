"""`afkb ontology homes` and `learn`: from a user's own maps to an extension of the network."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, tell
from afkb.cli.state import state_of
from afkb.errors import MapError

if TYPE_CHECKING:
    from afkb.learning import Lessons

_SHOWN = 15
_NAMES_SHOWN = 12


def homes(
    ctx: typer.Context,
    maps: Annotated[list[Path], typer.Argument(metavar="MAP...", help="Maps of homes.")],
    out: Annotated[Path, typer.Option(help="CSV table to write.")],
) -> None:
    """Write what stands in which room of mapped homes as a table, to be corrected by hand.

    A row a room: its purpose, and the things that were recognised in it. What could be several
    things is in the column `unsure`, which nobody reads but you. Correct the names and numbers, add
    what was overlooked; then `afkb ontology learn`.

    Example: afkb ontology homes flat-1 flat-2 --out my-homes.csv
    """
    from afkb.learning import rooms_of, table_text
    from afkb.store import load

    rooms = [room for folder in maps for room in rooms_of(load(folder))]
    text = table_text(rooms, state_of(ctx).host.knowledge_base)
    if out.exists():
        raise MapError(f"{out}: is there already, perhaps corrected; choose another --out")
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise MapError(f"{out}: can't be written: {error.strerror}; choose --out") from error
    unsure = sum(len(room.unsure) for room in rooms)
    tell(f"{out}: {len(rooms)} rooms; correct it ({unsure} things are unsure), then:")
    tell(f"afkb ontology learn {out} --out {out.with_suffix('.yaml')}")


def learn(
    tables: Annotated[list[Path], typer.Argument(metavar="TABLE...", help="Tables of homes.")],
    out: Annotated[Path, typer.Option(help="Extension to write, a .yaml file.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Learn from homes of your own: an extension that refits the network's figures.

    The ontology's figures are where yours begin: each counts for eight rooms. Use the extension
    wherever there is `--ontology`. It names the tables, so that a table that is corrected
    later is counted anew.

    Example: afkb ontology learn my-homes.csv --out my-homes.yaml
    """
    from afkb.learning import learnt
    from afkb.learning.extension import check_out, write_extension

    check_out(out)
    lessons = learnt(tables)
    write_extension(tables, out)
    _show(lessons, as_json)
    tell(
        f"{out}: learnt from {lessons.homes} homes, {lessons.rooms} rooms, {lessons.things} things"
    )


def _show(lessons: Lessons, as_json: bool) -> None:
    names = {
        "things": {n: c for met in lessons.unknown.things.values() for n, c in met.most_common()},
        "rooms": {n: c for met in lessons.unknown.rooms.values() for n, c in met.most_common()},
    }
    if as_json:
        counted = {"homes": lessons.homes, "rooms": lessons.rooms, "things": lessons.things}
        changed = [asdict(lesson) for lesson in lessons.changed]
        print_json(counted | {"changed": changed, "unknown_names": names})
        return
    rows = [
        (
            lesson.category,
            lesson.room,
            "" if lesson.before is None else f"{lesson.before:.3f}",
            f"{lesson.after:.3f}",
            f"{lesson.holding:g} of {lesson.rooms:g}",
        )
        for lesson in lessons.changed[:_SHOWN]
    ]
    columns = ["thing", "in a", "before", "after", "own rooms with it"]
    print_table(columns, rows, numbers=["before", "after"])
    for what, met in names.items():
        if met:
            shown = ", ".join(f"{n} ({c})" for n, c in list(met.items())[:_NAMES_SHOWN])
            tell(f"{len(met)} names of {what} not understood, and left out: {shown}")
