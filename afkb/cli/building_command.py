"""`afkb ontology build`: makes the ontology from its tables."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import tell
from afkb.errors import KnowledgeError


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
