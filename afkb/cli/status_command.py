"""`afkb ontology status`: what the ontology states, and how far it is vouched for."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb.quality.counts import KindCount


def status(
    ctx: typer.Context,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Count what is stated, by kind and status, with the shares that are vouched for.

    Provenance: a status and a source. Two sources: two public tables, or one and the paper, speak
    for it. Reviewed: a person judged it.

    Example: afkb ontology status
    """
    from afkb.ontology.names import STATUSES
    from afkb.quality.checked import Checked
    from afkb.quality.counts import count_statements

    counts = count_statements(Checked.of_files(state_of(ctx).host.knowledge_base.files).graph)
    if as_json:
        print_json([asdict(count) for count in counts])
        return
    shares = ["provenance", "two sources", "reviewed"]
    numbers = ["number", *STATUSES, *shares]
    print_table(["", *numbers], [_row(count, STATUSES) for count in counts], numbers=numbers)


def _row(count: KindCount, statuses: tuple[str, ...]) -> tuple[object, ...]:
    vouched = (count.with_provenance, count.with_two_sources, count.reviewed)
    shares = (f"{part / count.number:.0%}" for part in vouched)
    return (count.kind, count.number, *(count.by_status.get(s, 0) for s in statuses), *shares)
