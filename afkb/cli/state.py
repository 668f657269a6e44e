"""What every command is handed besides its own arguments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from afkb.plugins.host import PluginHost


@dataclass(frozen=True, slots=True)
class CliState:
    """The plugin host, and whether errors show their traceback; `ctx.obj` of every command."""

    host: PluginHost
    debug: bool = False


def state_of(ctx: typer.Context) -> CliState:
    """The state a command runs with; commands of plugins take a `typer.Context` and call this.

    @cli.command()
    def stats(ctx: typer.Context, map_folder: Path) -> None:
        host = state_of(ctx).host
    """
    state = ctx.find_object(CliState)
    if state is None:
        raise RuntimeError("not run through afkb.cli.app: no CliState on the context")
    return state
