"""`afkb ontology status`: what the ontology states, and how far it is vouched for."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.quality.counts import KindCount


def status(
    ctx: typer.Context,
    groundings: Annotated[
        bool, typer.Option("--groundings", help="List how each affordance is grounded instead.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Count what is stated, by kind and status, with the shares that are vouched for.

    Provenance: a status and a source. Two sources: two public tables, or one and the paper, speak
    for it. Reviewed: a person judged it.

    Example: afkb ontology status
    """
    if groundings:
        _print_groundings(state_of(ctx).host.knowledge_base, as_json)
        return
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
    print_text(_summary(state_of(ctx).host.knowledge_base))


def _summary(base: AfNet) -> str:
    """How many features are grounded, and how, in one line."""
    how = Counter(", ".join(feature.grounded_by) for feature in base.features.values())
    return "features grounded by " + "; ".join(f"{by or 'nothing'}: {n}" for by, n in how.items())


def _print_groundings(base: AfNet, as_json: bool) -> None:
    keys = ("grounded_by", "grounded_on", "grounding_strength", "grounding_reason")
    rows = [{"feature": f.name} | {k: getattr(f, k) for k in keys} for f in base.features.values()]
    if as_json:
        print_json(rows)
        return
    print_table(
        ["feature", "grounded by", "on", "strength", "reason"],
        [
            (f.name, ", ".join(f.grounded_by), ", ".join(f.grounded_on),
             f"{f.grounding_strength:g}" if f.grounding_strength else "", f.grounding_reason)
            for f in base.features.values()
        ],
        numbers=("strength",),
    )  # fmt: skip


def _row(count: KindCount, statuses: tuple[str, ...]) -> tuple[object, ...]:
    vouched = (count.with_provenance, count.with_two_sources, count.reviewed)
    shares = (f"{part / count.number:.0%}" for part in vouched)
    return (count.kind, count.number, *(count.by_status.get(s, 0) for s in statuses), *shares)
