"""The contract of an ontology extension and of commands that a plugin adds."""

from __future__ import annotations

from pathlib import Path

import pluggy
import typer

from afkb.errors import KnowledgeError
from afkb.knowledge import AfNet
from afkb.plugins import PROJECT, hookspecs
from afkb.testing.require import require


def check_ontology(path: Path, knowledge_base: AfNet) -> None:
    """Raise unless the file or folder extends the ontology and takes nothing away from it."""
    who = f"ontology {path.name}"
    require(path.exists(), who, f"nothing at {path}", "return a path inside the package")
    try:
        extended = knowledge_base.extended([path])
        words = set(extended.features) | set(extended.categories) | set(extended.rooms)
    except KnowledgeError as error:
        raise AssertionError(f"{who}: does not load: {error}") from error
    before = {*knowledge_base.features, *knowledge_base.categories, *knowledge_base.rooms}
    lost = sorted(before - words)
    require(not lost, who, f"takes away {lost}", "add to the ontology, redefine nothing")
    files = path.resolve() in {p.resolve() for p in extended.files}
    require(files, who, "is not among the files in use", "its path must reach SPARQL queries too")


def check_commands(plugin: object, knowledge_base: AfNet) -> None:
    """Raise unless each command that the plugin adds has help with an example.

    `plugin`: the module or object with the `afkb_commands` hook.
    """
    cli = typer.Typer()
    manager = pluggy.PluginManager(PROJECT)
    manager.add_hookspecs(hookspecs)
    manager.register(plugin)
    manager.hook.afkb_commands(cli=cli, knowledge_base=knowledge_base)
    who = f"plugin {getattr(plugin, '__name__', type(plugin).__name__)}"
    require(bool(cli.registered_commands), who, "adds no command", "use @cli.command()")
    for command in cli.registered_commands:
        function = command.callback
        name = command.name or getattr(function, "__name__", "?")
        text = command.help or (function.__doc__ if function else None) or ""
        has_example = f"afkb {name}" in f"{text} {command.epilog or ''}"
        require(
            has_example, f"{who}, command {name!r}", "help has no example", f"show afkb {name} …"
        )
