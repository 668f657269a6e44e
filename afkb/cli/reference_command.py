"""`afkb ontology reference`: the ontology as one page to browse."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import print_text, tell
from afkb.cli.state import state_of
from afkb.errors import KnowledgeError


def reference(
    ctx: typer.Context,
    out: Annotated[Path, typer.Option(metavar="FILE.html", help="Page to write.")],
    extensions: Annotated[
        list[Path] | None,
        typer.Option("--ontology", metavar="FILE", help="An extension to show along; repeatable."),
    ] = None,
) -> None:
    """Write one page that shows every affordance, object, room and relation; opens from disk.

    The same ontology gives the same bytes. `page.html#Mug` shows the mug, `page.html#filter=wood`
    what has to do with wood.

    Example: afkb ontology reference --out reference.html
    """
    from afkb.ontology.writing import put_whole
    from afkb.reference import reference_page

    page = reference_page(state_of(ctx).host.knowledge_base.extended(extensions or []))
    try:
        put_whole(out, page)
    except OSError as error:
        raise KnowledgeError(f"{out}: can't be written: {error.strerror}; choose --out") from error
    print_text(str(out))
    tell(f"{len(page.encode()) / 1e6:.1f} MB; open it in a browser")
