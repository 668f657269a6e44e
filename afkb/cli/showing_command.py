"""`afkb ontology show`: one term, or the names of all."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.knowledge.model import Statement


def show(
    ctx: typer.Context,
    name: Annotated[str | None, typer.Argument(help="A term, as in `Mug`.")] = None,
    extensions: Annotated[
        list[Path] | None,
        typer.Option("--ontology", metavar="FILE", help="An extension to show along; repeatable."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Show one term with all that is stated of it, or the names of all.

    Of an affordance also what its grounding measures, of what, and between which values.

    Example: afkb ontology show Mug
    """
    base = state_of(ctx).host.knowledge_base.extended(extensions or [])
    if name is None:
        names = {what: [item.name for item in items] for what, items in _items(base).items()}
        if as_json:
            print_json(names)
        else:
            print_table(["", "names"], [(what, ", ".join(n)) for what, n in names.items()])
        return
    statements = base.statements_about(name) | _measures(base, name)
    if as_json:
        print_json(statements)
    else:
        rows = [(prop, value) for prop, values in statements.items() for value in values]
        print_table(["property", "value"], rows, title=base.iri(name))


def _measures(base: AfNet, name: str) -> dict[str, list[str]]:
    """The fuzzy ranges of a feature's grounding, a line each."""
    feature = base.features.get(name)
    if feature is None or not feature.parameters:
        return {}
    lines = []
    for measure, t in sorted(feature.parameters.items()):
        known = base.measures.get(measure)
        unit = f" {known.measured_in}" if known and known.measured_in != "1" else ""
        lines.append(
            f"{measure}: 0 up to {t.z1:g}, 1 from {t.n1:g} to {t.n2:g}, 0 from {t.z2:g}{unit}"
        )
    return {"measures": lines}


def _items(base: AfNet) -> dict[str, list[Statement]]:
    return {
        "features": list(base.features.values()),
        "measures": list(base.measures.values()),
        "scales": list(base.scales.values()),
        "categories": list(base.categories.values()),
        "duals": list(base.duals),
        "co-occurrences": list(base.co_occurrences),
        "evidence classes": list(base.evidence_classes.values()),
        "rooms": list(base.rooms.values()),
    }
