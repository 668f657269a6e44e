"""`afkb ontology gather`: what public tables say of the categories, as evidence for the rules."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import tell


def gather(
    public: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of public tables.")],
    tables: Annotated[
        Path | None,
        typer.Option(help="Folder of tables.  [default: beside the bundled ontology]"),
    ] = None,
) -> None:
    """Look up every name of `source_names` in the public tables; write what they say of it.

    Evidence for afbits goes into the folder `evidence`, synsets and items into `links.csv`.

    The same tables give the same bytes. `afkb ontology build` comes after it.

    Example: afkb ontology gather knowledge --tables ontology/tables
    """
    from afkb.errors import KnowledgeError
    from afkb.ontology.bundled import bundled_ontology
    from afkb.ontology.gather import gather as gathered
    from afkb.ontology.links import gather_links
    from afkb.ontology.tables import read_table
    from afkb.ontology.writing import put_whole

    tables = tables or bundled_ontology().parent / "tables"
    names = read_table(tables, "source_names")
    found = gathered(public, names)
    links = gather_links(public, names)
    out = tables / "evidence"
    try:
        out.mkdir(exist_ok=True)
        for source, text in found.items():
            put_whole(out / f"{source}.csv", text)
        put_whole(tables / "links.csv", links)
    except OSError as error:
        raise KnowledgeError(f"{out}: can't be written: {error.strerror}; give --tables") from error
    tell(f"{out}: {sum(text.count(chr(10)) - 1 for text in found.values())} facts")
