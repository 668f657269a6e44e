"""The parts of the benchmark, in the order they run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any, NamedTuple

from bench.detectors.data import Asked

PARTS = (
    "surfaces",
    "mosd",
    "containers",
    "movability",
    "redkitchen",
    "robustness",
    "calibration",
    "doorways",
    "overlays",
    "cost",
    "speed",
)
"""Each is a module of this package."""


class Part(NamedTuple):
    """One part: what data it needs, what measures it, and what says the result in lines."""

    needs: tuple[str, ...]
    run: Callable[[Asked], dict[str, Any]]
    table: Callable[[dict[str, Any]], Iterator[str]]


def part(name: str) -> Part:
    """A part by its name; loads only what it needs."""
    module = import_module(f"bench.detectors.{name}")
    return Part(module.NEEDS, module.run, module.table)
