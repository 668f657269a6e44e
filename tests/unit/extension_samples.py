"""Extensions as users write them, in YAML and tables, and what is said of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.errors import KnowledgeError
from afkb.extensions import read_stack
from afkb.knowledge import bundled_ontology

HEAD = "extension: home\n"
KIOSK = """\
categories:
  Kiosk:
    broader: Furniture
    length_m: [0.4, 0.8]
    width_m: [0.3, 0.5]
    height_m: [1.0, 1.5]
"""
"""The least that a category says; `Kiosk` is on line 3 of a file that starts with the head."""


def yaml_file(folder: Path, body: str, name: str = "home.yaml", head: str = HEAD) -> Path:
    """An extension in YAML with that body below its first line."""
    path = folder / name
    path.write_text(head + body, encoding="utf-8")
    return path


def table(folder: Path, name: str, *lines: str) -> Path:
    """A CSV file of those lines."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def problems(*files: Path) -> list[str]:
    """What is said of extensions that are read one after another, without the folder's path."""
    with pytest.raises(KnowledgeError) as caught:
        read_stack([bundled_ontology(), *files])
    return [line.replace(f"{files[0].parent}/", "") for line in str(caught.value).splitlines()]
