"""`afkb plugins`: what is registered, and from where."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

import typer

from afkb.cli.output import print_json, print_table
from afkb.cli.state import state_of
from afkb.errors import PluginError


def plugins(
    ctx: typer.Context,
    hook: Annotated[
        str | None,
        typer.Option("--hook", metavar="NAME", help="Only those that implement this hook."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """List the registered plugins with their hooks and the package each came from.

    Example: afkb plugins --hook afkb_detectors
    """
    host = state_of(ctx).host
    known = _hooks()
    if hook is not None and hook not in known:
        raise PluginError(f"no hook named {hook!r}; hooks: {', '.join(known)}")
    found = sorted(
        (p for p in host.plugins() if hook is None or hook in p.hooks), key=lambda p: p.name
    )
    if as_json:
        print_json([asdict(plugin) for plugin in found])
        return
    print_table(
        ["name", "package", "version", "hooks"],
        [(p.name, p.distribution, p.version, ", ".join(p.hooks)) for p in found],
    )


def _hooks() -> list[str]:
    from afkb.plugins import hookspecs

    return sorted(name for name in vars(hookspecs) if name.startswith("afkb_"))
