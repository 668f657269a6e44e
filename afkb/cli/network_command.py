"""`afkb ontology network`: the Bayesian network, for other programs to read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from afkb.cli.output import print_text
from afkb.cli.state import state_of
from afkb.errors import KnowledgeError


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
