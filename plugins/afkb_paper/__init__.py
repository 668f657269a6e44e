"""The paper's three scenarios mapped and judged: the command `reproduce`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    import typer

    from afkb.flow import Truth
    from afkb.knowledge import AfNet


@hookimpl
def afkb_commands(cli: typer.Typer, knowledge_base: AfNet) -> None:
    """Add `reproduce`."""
    from afkb_paper.command import reproduce

    cli.command()(reproduce)


@hookimpl
def afkb_truth(uri: str, knowledge_base: AfNet) -> Truth | None:
    """Return what `truth.json` says, in a recording's folder or beside its `bag/`."""
    from afkb_paper.truth_file import truth_beside

    return truth_beside(uri)
