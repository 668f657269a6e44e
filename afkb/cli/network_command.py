"""`afkb ontology network`: the Bayesian network, to read, and for other programs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.state import state_of
from afkb.errors import KnowledgeError

if TYPE_CHECKING:
    from afkb.inference.structure import Node


def network(
    ctx: typer.Context,
    out: Annotated[Path | None, typer.Option(help="BIF file to write.")] = None,
    of: Annotated[str, typer.Option(help="Nodes that this term is part of, one by one.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Every node, as JSON.")] = False,
) -> None:
    """Show the Bayesian network that is compiled from the ontology, or write it as BIF.

    Example: afkb ontology network --of Toilet
    """
    from afkb.inference import network_of
    from afkb.inference.structure import structure

    compiled = network_of(state_of(ctx).host.knowledge_base)
    if out is not None:
        if not out.absolute().parent.is_dir():
            raise KnowledgeError(f"{out}: can't be written: no such folder; choose --out")
        try:
            compiled.write_bif(out)
        except OSError as error:
            raise KnowledgeError(
                f"{out}: can't be written: {error.strerror}; choose --out"
            ) from error
        print_text(str(out))
        return
    nodes = [node for node in structure(compiled) if not of or _is_of(node, of)]
    if of and not nodes:
        raise KnowledgeError(f"no node of the network has {of!r} in it; name a term of `ontology`")
    if as_json:
        print_json(
            [
                {
                    "name": n.name,
                    "what": n.what,
                    "parents": list(n.parents),
                    "statements": list(n.statements),
                }
                for n in nodes
            ]
        )
    elif of:
        _print_nodes(nodes)
    else:
        _print_kinds(nodes)


def _is_of(node: Node, term: str) -> bool:
    """Whether the node, one of its parents or one of its statements is of the term."""
    names = (node.name, *node.parents)
    told = {part for name in node.statements for part in name.split(".")}
    return term in told or any(name in (term, f"{term}InRoom", f"{term}There") for name in names)


def _print_nodes(nodes: Sequence[Node]) -> None:
    rows = [(n.name, n.what, ", ".join(n.parents) or "-", str(len(n.statements))) for n in nodes]
    print_table(("node", "what", "depends on", "statements"), rows)


def _print_kinds(nodes: Sequence[Node]) -> None:
    kinds = dict.fromkeys(n.what for n in nodes)
    rows = []
    for kind in kinds:
        of_kind = [n for n in nodes if n.what == kind]
        rows.append(
            (
                kind,
                str(len(of_kind)),
                str(sum(len(n.parents) for n in of_kind)),
                str(sum(len(n.statements) for n in of_kind)),
            )
        )
    print_table(("nodes", "how many", "edges", "statements behind them"), rows)
