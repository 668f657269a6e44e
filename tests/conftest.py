"""What all tests share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
COMPILES_NOTHING = (
    "afbit",
    "alignments",
    "bundled",
    "closure",
    "cli",
    "competency",
    "entity",
    "extension",
    "figures",
    "filtrations",
    "fleet",
    "knowledge",
    "modules",
    "network",
    "ontology",
    "pins",
    "quality",
    "reference",
    "store",
    "update",
)
"""Unit tests of files that begin so need no compiled kernel: they ask what is known, not seen."""

DOCUMENTS = ("test_docs.py", "test_locate_command.py", "test_route_command.py")
"""Tests that share the bundled home's map: one after the other, and long."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests that map come first, then tests that compile nothing: each kernel is compiled once.

    Two workers share them out in this order (`--no-loadscope-reorder`): while the one compiles
    kernels, which takes minutes in a fresh clone, the other has no need of them.
    """
    items.sort(key=lambda item: _turn(item.path))


def _turn(path: Path) -> int:
    if path.name in DOCUMENTS:
        return 0
    if path.name.removeprefix("test_").startswith(COMPILES_NOTHING):
        return 1
    return 2 if path.parent.name in ("e2e", "integration") else 3


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder of recordings: AFKB_DATA, else shared/data beside the repository."""
    folder = Path(os.environ.get("AFKB_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no recordings at {folder}; set AFKB_DATA to a folder that has them")
    return folder
