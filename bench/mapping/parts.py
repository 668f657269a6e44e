"""The parts of `python -m bench.mapping`, by name: a module each, imported when it is asked for.

A module has `add_arguments(parser)` (its recording, folder or log), `run(args)` (a result that
goes into JSON; raises `NoData` where its data are missing) and `table(result)` (its lines).
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from importlib import import_module
from typing import Any, Protocol, cast

PARTS = (
    "locate",
    "diff",
    "growth",
    "floorplans",
    "trajectory",
    "faults",
    "vacuum",
    "loops",
    "relations",
    "lightness",
    "paper",
    "deceived_hall",
)


class Part(Protocol):
    """One question about maps, measured."""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Add the options that name its data."""

    def run(self, args: argparse.Namespace) -> Any:
        """What was measured; raises `NoData` where its data are missing."""

    def table(self, result: Any) -> Iterable[str]:
        """The result as lines."""


def part(name: str) -> Part:
    """The part of this name."""
    return cast(Part, import_module(f"bench.mapping.{name}"))
