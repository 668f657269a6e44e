"""Writes the extension that brings tables of homes to the network."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import yaml

from afkb.errors import KnowledgeError
from afkb.ontology.names import slug


def check_out(out: Path) -> None:
    """Raise `KnowledgeError` where there is a file already, or its name isn't YAML's."""
    if out.suffix not in (".yaml", ".yml"):
        raise KnowledgeError(f"{out}: an extension is written as YAML; end its name in .yaml")
    if out.exists():
        raise KnowledgeError(f"{out}: is there already; choose another --out, or remove it")


def write_extension(tables: Sequence[Path], out: Path) -> None:
    """Write a YAML extension whose homes are these tables, which stay where they are.

    Raises `KnowledgeError` where it can't be written.
    """
    check_out(out)
    beside = out.resolve().parent
    homes = [os.path.relpath(table.resolve(), beside) for table in tables]
    said = {"extension": slug(out.stem), "homes": [Path(home).as_posix() for home in homes]}
    text = "# Homes whose rooms are counted in: correct the tables, and figures follow.\n"
    text += yaml.safe_dump(said, sort_keys=False, allow_unicode=True)
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise KnowledgeError(f"{out}: can't be written: {error.strerror}; choose --out") from error
