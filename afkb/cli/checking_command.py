"""`afkb ontology check`: all quality gates in one command."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_text
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.quality.findings import Gate


def check(
    ctx: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[FILE]...", help="Extensions to check beside the ontology."),
    ] = None,
    require_reasoner: Annotated[
        bool, typer.Option("--require-reasoner", help="Fail where there is no Java.")
    ] = False,
    no_reasoner: Annotated[
        bool, typer.Option("--no-reasoner", help="Leave out the gate that takes longest.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")] = False,
) -> None:
    """Check the ontology, or extensions of it: reading, shapes, pitfalls, reasoner, questions.

    Prints a line for each gate, and each finding with file, line and mend. Exit code 1 where a
    gate failed. The reasoner needs Java; without it, that gate is not run. It looks at everything
    together and takes half a minute; --no-reasoner is for a quick look in between.

    Example: afkb ontology check my-home.owl
    """
    from afkb.quality.findings import FAILED
    from afkb.quality.gates import Reasoner, Task, run_gates

    if require_reasoner and no_reasoner:
        raise typer.BadParameter("--require-reasoner and --no-reasoner exclude each other")
    reasoner = Reasoner.REQUIRED if require_reasoner else Reasoner.WHERE_FOUND
    reasoner = Reasoner.LEFT_OUT if no_reasoner else reasoner

    known = state_of(ctx).host.knowledge_base
    base = known.extended(files or [])
    folder = known.files[0].parent
    task = Task(files, known.files, folder) if files else Task(known.files[:1], (), folder)
    gates = []
    for gate in run_gates(task, lambda: _read(base), reasoner):
        gates.append(gate)
        if not as_json:
            _tell(gate)
    if as_json:
        print_json([_plain(gate) for gate in gates])
    if any(gate.state == FAILED for gate in gates):
        raise typer.Exit(1)


def _read(base: AfNet) -> object:
    """Read as `afkb map` does, down to the network."""
    from afkb.inference import Network

    return Network.compile(base)


def _tell(gate: Gate) -> None:
    print_text(str(gate))
    for finding in gate.findings:
        print_text(f"  {finding}")


def _plain(gate: Gate) -> dict[str, object]:
    findings = [asdict(finding) for finding in gate.findings]
    return {"gate": gate.name, "state": gate.state, "note": gate.note, "findings": findings}
