"""`afkb ontology`: builds the ontology from its tables, checks extensions, shows its terms."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.checking_command import check
from afkb.cli.counting_command import count
from afkb.cli.gathering_command import gather
from afkb.cli.output import print_json, print_table, print_text, tell
from afkb.cli.reference_command import reference
from afkb.cli.starter_command import new
from afkb.cli.state import state_of
from afkb.cli.status_command import status
from afkb.errors import KnowledgeError

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.knowledge.model import Statement

app = typer.Typer(no_args_is_help=True, help="Build, check and show the ontology.")
app.command()(count)
app.command()(gather)
app.command()(new)
app.command()(check)
app.command()(status)
app.command()(reference)

_Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]


@app.command()
def build(
    tables: Annotated[
        Path | None,
        typer.Option(help="Folder of tables.  [default: beside the bundled ontology]"),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="File to write.  [default: the bundled ontology]")
    ] = None,
) -> None:
    """Build the RDF/XML ontology from its tables; the same tables give the same bytes.

    Its modules are written beside it, into the folder `modules`, and the alignments that are built
    from tables into the folder `alignments`.

    Example: afkb ontology build --tables ontology/tables --out ontology/afnet.owl
    """
    from afkb.ontology.build import write_alignments, write_ontology
    from afkb.ontology.bundled import bundled_ontology

    tables = tables or bundled_ontology().parent / "tables"
    out = out or bundled_ontology()
    try:
        count = write_ontology(tables, out, out.parent / "modules")
        write_alignments(tables, out.parent / "alignments")
    except OSError as error:
        raise KnowledgeError(f"{out}: can't be written: {error.strerror}; choose --out") from error
    tell(f"{out}: {count} statements")


@app.command()
def show(
    ctx: typer.Context,
    name: Annotated[str | None, typer.Argument(help="A term, as in `Mug`.")] = None,
    extensions: Annotated[
        list[Path] | None,
        typer.Option("--ontology", metavar="FILE", help="An extension to show along; repeatable."),
    ] = None,
    as_json: _Json = False,
) -> None:
    """Show one term with all that is stated of it, or the names of all.

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
    statements = base.statements_about(name)
    if as_json:
        print_json(statements)
    else:
        rows = [(prop, value) for prop, values in statements.items() for value in values]
        print_table(["property", "value"], rows, title=base.iri(name))


@app.command()
def network(
    ctx: typer.Context,
    out: Annotated[Path, typer.Option(help="BIF file to write.")],
) -> None:
    """Write the Bayesian network that is compiled from the ontology, as BIF.

    Example: afkb ontology network --out afnet.bif
    """
    from afkb.inference import Network

    compiled = Network.compile(state_of(ctx).host.knowledge_base)
    try:
        compiled.write_bif(out)
    except OSError as error:
        raise KnowledgeError(f"{out}: can't be written: {error.strerror}; choose --out") from error
    print_text(str(out))


def _items(base: AfNet) -> dict[str, list[Statement]]:
    return {
        "features": list(base.features.values()),
        "scales": list(base.scales.values()),
        "categories": list(base.categories.values()),
        "duals": list(base.duals),
        "co-occurrences": list(base.co_occurrences),
        "evidence classes": list(base.evidence_classes.values()),
        "rooms": list(base.rooms.values()),
    }
