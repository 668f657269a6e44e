"""constraints.txt pins everything that gets installed, and says nothing of where it came from."""

from __future__ import annotations

import re
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

LINES = (Path(__file__).parents[2] / "constraints.txt").read_text().splitlines()
PINS = {canonicalize_name(line.split("==")[0]) for line in LINES if not line.startswith("#")}


def needed(name: str, extras: frozenset[str], seen: set[tuple[str, frozenset[str]]]) -> None:
    """Collect what is installed for a requirement, with what it needs in turn."""
    key = (canonicalize_name(name), extras)
    try:
        requires = distribution(name).requires or []
    except PackageNotFoundError:
        return
    if key in seen:
        return
    seen.add(key)
    for text in requires:
        requirement = Requirement(text)
        marker = requirement.marker
        if marker is None or any(marker.evaluate({"extra": e}) for e in {"", *extras}):
            needed(requirement.name, frozenset(requirement.extras), seen)


def test_every_line_is_a_name_and_an_exact_version() -> None:
    wrong = [x for x in LINES if not re.fullmatch(r"#.*|[A-Za-z0-9._-]+==\d[\w.]*", x)]
    assert not wrong


def test_everything_that_is_installed_for_the_project_is_pinned() -> None:
    seen: set[tuple[str, frozenset[str]]] = set()
    needed("afkb", frozenset({"dev"}), seen)
    names = {name for name, _ in seen} - {"afkb", "setuptools"}
    assert len(names) > 40
    assert not names - PINS
