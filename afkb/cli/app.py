"""The `afkb` command: built from what reads RDF and from what plugins bring."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from afkb import __version__
from afkb.cli.errors import told_in_one_line
from afkb.cli.state import CliState
from afkb.errors import PluginError

if TYPE_CHECKING:
    from afkb.plugins.host import PluginHost

_ONTOLOGY_COMMANDS = "afkb.cli.ontology"


class _Commands(TyperGroup):
    """All commands, built-in and plugins' alike; here their errors become one line."""

    def invoke(self, ctx: Any) -> Any:
        with told_in_one_line(bool(ctx.params.get("debug"))):
            return super().invoke(ctx)


def build_cli(host: PluginHost) -> typer.Typer:
    """The whole command line over a plugin host; commands reach it by `state_of(ctx).host`."""
    cli = typer.Typer(
        cls=_Commands,
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        help="Maps of what a place affords: from posed depth and laser to SPARQL, on a CPU.",
        epilog="Start with: afkb demo",
    )

    @cli.callback()
    def common(
        ctx: typer.Context,
        debug: Annotated[
            bool, typer.Option("--debug", help="Show the traceback of an error.")
        ] = False,
        version: Annotated[
            bool,
            typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
        ] = False,
    ) -> None:
        ctx.obj = CliState(host, debug)

    _add_scene_commands(cli)
    _add_plugin_commands(cli, host)
    return cli


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"afkb {__version__}")
        raise typer.Exit


def _add_scene_commands(cli: typer.Typer) -> None:
    from afkb.cli import (
        find_command,
        plugin_commands,
        query_command,
        scene_commands,
        serve_command,
        store_commands,
        why_command,
    )

    cli.command()(scene_commands.info)
    cli.command()(scene_commands.rooms)
    cli.command()(query_command.query)
    cli.command()(find_command.find)
    cli.command()(why_command.why)
    cli.command()(serve_command.serve)
    cli.command()(plugin_commands.plugins)
    cli.add_typer(store_commands.app, name="store")
    if importlib.util.find_spec(_ONTOLOGY_COMMANDS):
        cli.add_typer(importlib.import_module(_ONTOLOGY_COMMANDS).app, name="ontology")


def _add_plugin_commands(cli: typer.Typer, host: PluginHost) -> None:
    """Ask plugin by plugin, so that an error can name whose it is."""
    manager = host.manager
    everyone = [plugin for _, plugin in manager.list_name_plugin()]
    for name, plugin in manager.list_name_plugin():
        others = [other for other in everyone if other is not plugin]
        hook = manager.subset_hook_caller("afkb_commands", others)
        try:
            hook(cli=cli, knowledge_base=host.knowledge_base)
        except (ImportError, AttributeError, TypeError, ValueError) as error:
            raise PluginError(
                f"plugin {name!r} can't add its commands: {error}; mend it or uninstall it"
            ) from error


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; `--debug` may stand anywhere."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in given
    if debug:
        given = ["--debug", *(argument for argument in given if argument != "--debug")]
    cli = _with_plugins(debug)
    cli(args=given, prog_name="afkb")


def _with_plugins(debug: bool) -> typer.Typer:
    try:
        with told_in_one_line(debug):
            from afkb.plugins.host import PluginHost

            return build_cli(PluginHost())
    except typer.Exit as exit_:
        sys.exit(exit_.exit_code)


if __name__ == "__main__":
    main()
